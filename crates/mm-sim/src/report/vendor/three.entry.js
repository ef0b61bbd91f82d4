// What the report uses of three.js, and nothing else.
export {
  BoxGeometry,
  Color,
  CylinderGeometry,
  DirectionalLight,
  GridHelper,
  Group,
  HemisphereLight,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Scene,
  SphereGeometry,
  Vector3,
  WebGLRenderer,
  setConsoleFunction,
} from 'three';
export { OrbitControls } from 'three/addons/controls/OrbitControls.js';
export { Line2 } from 'three/addons/lines/Line2.js';
export { LineGeometry } from 'three/addons/lines/LineGeometry.js';
export { LineMaterial } from 'three/addons/lines/LineMaterial.js';
