// The scene in WebGL.

THREE.setConsoleFunction(() => {});

const HUES = { base: 0.55, wheel: 0.12 };

/** Whether the processor does what a graphics card should: then a plain canvas is quicker. */
function isSoftware(context) {
  let name = context.getParameter(context.RENDERER);
  if (name === 'WebKit WebGL') {
    const more = context.getExtension('WEBGL_debug_renderer_info');
    if (more) name = context.getParameter(more.UNMASKED_RENDERER_WEBGL);
  }
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

class SolidScene {
  /** The scene on a canvas; null where there is no WebGL, or only one that the processor computes, unless it is asked for. */
  static on(canvas, isForced) {
    const context = canvas.getContext('webgl2', { antialias: true, alpha: true, preserveDrawingBuffer: true });
    if (!context) return null;
    if (!isForced && isSoftware(context)) return null;
    try {
      return new SolidScene(canvas, context);
    } catch {
      return null;
    }
  }

  constructor(canvas, context) {
    this.renderer = new THREE.WebGLRenderer({ canvas, context, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.scene = new THREE.Scene();
    const sun = new THREE.DirectionalLight(0xffffff, 1.9);
    sun.position.set(-2, -4, 6);
    this.scene.add(sun, new THREE.HemisphereLight(0xffffff, 0x8890a0, 1.6));
    this.size = [1, 1];
  }

  resize(width, height) {
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.size = [width, height];
    for (const line of this.lines || []) line.material.resolution.set(width, height);
  }

  /** A line that is drawn after the robots and the lines of a lower order, however close they are. */
  line(points, color, width, order, more) {
    const geometry = new THREE.LineGeometry();
    geometry.setPositions(points.length >= 6 ? points : new Float32Array(6));
    const material = new THREE.LineMaterial({ color, linewidth: width, transparent: true, depthWrite: false, ...more });
    material.resolution.set(...this.size);
    const made = new THREE.Line2(geometry, material);
    made.computeLineDistances();
    made.frustumCulled = false;
    made.renderOrder = order;
    this.lines.push(made);
    this.group.add(made);
    return made;
  }

  /** Builds what the group shows, with the colours of the theme. */
  build() {
    if (this.group) {
      this.group.traverse((part) => {
        if (part.geometry) part.geometry.dispose();
        if (part.material) part.material.dispose();
      });
      this.scene.remove(this.group);
    }
    this.group = new THREE.Group();
    this.lines = [];
    this.scene.add(this.group);
    this.floor();
    this.desired = this.line(state.group.runs[0].path, ink('ink'), 1.6, 100, { dashed: true, dashSize: 0.035, gapSize: 0.03 });
    this.parts = state.group.runs.map((run, i) => this.robot(run, i));
  }

  floor() {
    const [low, high] = boundsOf(state.group);
    const side = Math.max(high[0] - low[0], high[1] - low[1]) > 12 ? 1 : 0.5;
    const count = 2 * Math.ceil(Math.max(high[0] - low[0], high[1] - low[1]) / side / 2) + 4;
    const grid = new THREE.GridHelper(count * side, count, ink('floor-strong'), ink('floor'));
    grid.rotation.x = Math.PI / 2;
    const round = (axis) => side * Math.round((0.5 * (low[axis] + high[axis])) / side);
    grid.position.set(round(0), round(1), 0);
    this.group.add(grid);
  }

  /** A robot and its paths; the later of two in one place is on top, and what is below is wider. */
  robot(run, number) {
    const onTop = { polygonOffset: true, polygonOffsetFactor: -number, polygonOffsetUnits: -8 * number };
    const color = new THREE.Color(colorOf(run));
    const several = state.group.runs.length > 1;
    const links = new Map();
    for (const link of run.robot.links) {
      const part = new THREE.Group();
      part.matrixAutoUpdate = false;
      for (const body of link.shapes) {
        const geometry = body.kind === 'box'
          ? new THREE.BoxGeometry(...body.size)
          : new THREE.CylinderGeometry(body.radius, body.radius, body.length, 28).rotateX(Math.PI / 2);
        const dark = HUES[body.material];
        const tint = dark ? color.clone().lerp(new THREE.Color(theme() === 'dark' ? 0x50575f : 0x4a5058), 1 - dark) : color;
        const mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ color: tint, transparent: several, opacity: several ? 0.9 : 1, ...onTop }));
        mesh.matrixAutoUpdate = false;
        mesh.matrix.set(...body.at, 0, 0, 0, 1);
        part.add(mesh);
      }
      links.set(link.name, part);
      this.group.add(part);
    }
    const ball = new THREE.Mesh(new THREE.SphereGeometry(0.03, 20, 14), new THREE.MeshLambertMaterial({ color: ink('ink') }));
    this.group.add(ball);
    const way = wayOf(run, state.magnify);
    return {
      run,
      links,
      ball,
      way,
      future: this.line(way.points, color, 1.4, 1, { opacity: 0.28 }),
      past: this.line(way.points, color, wayWidth(number), 2 + number, {}),
    };
  }

  /** Draws the scene at the time of the replay. */
  draw(camera) {
    for (const { run, links, ball, way, past, future } of this.parts) {
      const frames = framesOf(run, state.t);
      for (const [name, part] of links) {
        part.visible = run.isShown;
        const frame = frames.get(name);
        if (frame) part.matrix.set(...frame, 0, 0, 0, 1);
      }
      const tip = tipOf(frames);
      ball.visible = run.isShown && Boolean(tip);
      if (tip) ball.position.set(...tip);
      const done = Math.max(before(way.times, state.t), 0);
      past.geometry.instanceCount = done;
      past.visible = run.isShown && done > 0;
      future.visible = run.isShown;
    }
    this.desired.visible = state.isDesiredShown;
    this.renderer.render(this.scene, camera);
  }
}
