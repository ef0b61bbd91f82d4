// The robot of a run: its URDF of boxes and cylinders, and where its links are at a time.

/** Rows of a 3 x 4 matrix that turns by an angle about a unit axis and then moves. */
function pose([x, y, z], angle, [px, py, pz]) {
  const s = Math.sin(angle);
  const c = Math.cos(angle);
  const d = 1 - c;
  return [
    c + x * x * d, x * y * d - z * s, x * z * d + y * s, px,
    y * x * d + z * s, c + y * y * d, y * z * d - x * s, py,
    z * x * d - y * s, z * y * d + x * s, c + z * z * d, pz,
  ];
}

/** The product of two 3 x 4 poses. */
function times(a, b) {
  const out = new Array(12);
  for (let row = 0; row < 3; row += 1) {
    for (let column = 0; column < 4; column += 1) {
      const i = 4 * row;
      out[i + column] = a[i] * b[column] + a[i + 1] * b[4 + column] + a[i + 2] * b[8 + column] + (column === 3 ? a[i + 3] : 0);
    }
  }
  return out;
}

/** A point of a pose's frame in the world. */
function moved(m, [x, y, z]) {
  return [0, 4, 8].map((i) => m[i] * x + m[i + 1] * y + m[i + 2] * z + m[i + 3]);
}

const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];

/** Roll, pitch and yaw about the fixed axes, as URDF has them, and an origin. */
function placed(node) {
  const origin = node && node.querySelector(':scope > origin');
  const three = (name) => {
    const text = origin && origin.getAttribute(name);
    const values = (text || '0 0 0').trim().split(/\s+/).map(Number);
    return values.length === 3 && values.every(Number.isFinite) ? values : [0, 0, 0];
  };
  const [roll, pitch, yaw] = three('rpy');
  const turned = times(times(pose([0, 0, 1], yaw, three('xyz')), pose([0, 1, 0], pitch, [0, 0, 0])), pose([1, 0, 0], roll, [0, 0, 0]));
  return turned;
}

/** A box or a cylinder of a link; null for anything else. */
function shape(visual) {
  const box = visual.querySelector('geometry > box');
  const cylinder = visual.querySelector('geometry > cylinder');
  const material = visual.querySelector('material');
  const body = { at: placed(visual), material: material ? material.getAttribute('name') : '' };
  if (box) return { ...body, kind: 'box', size: box.getAttribute('size').trim().split(/\s+/).map(Number) };
  if (cylinder) {
    return { ...body, kind: 'cylinder', radius: Number(cylinder.getAttribute('radius')), length: Number(cylinder.getAttribute('length')) };
  }
  return null;
}

/** Links with their shapes, and joints from the root on. */
function robotOf(urdf) {
  const file = new DOMParser().parseFromString(urdf || '<robot/>', 'text/xml');
  const links = [...file.querySelectorAll('robot > link')].map((node) => ({
    name: node.getAttribute('name'),
    shapes: [...node.querySelectorAll(':scope > visual')].map(shape).filter(Boolean),
  }));
  const joints = [...file.querySelectorAll('robot > joint')].map((node) => {
    const axis = node.querySelector('axis');
    return {
      name: node.getAttribute('name'),
      parent: node.querySelector('parent').getAttribute('link'),
      child: node.querySelector('child').getAttribute('link'),
      at: placed(node),
      axis: axis ? axis.getAttribute('xyz').trim().split(/\s+/).map(Number) : [0, 0, 0],
    };
  });
  const children = new Set(joints.map((joint) => joint.child));
  const root = links.find((link) => !children.has(link.name));
  return { links, joints, root: root ? root.name : '' };
}

const ANGLES = {
  right_wheel: 'wheel_right_rad',
  left_wheel: 'wheel_left_rad',
  joint1: 'joint1_rad',
  joint2: 'joint2_rad',
  joint3: 'joint3_rad',
};

/** Poses of all links of a run's robot at a time, by name. */
function framesOf(run, t) {
  const frames = new Map([[run.robot.root, pose([0, 0, 1], at(run, 'heading_rad', t), [at(run, 'x_m', t), at(run, 'y_m', t), 0])]]);
  for (const joint of run.robot.joints) {
    const parent = frames.get(joint.parent) || IDENTITY;
    const angle = ANGLES[joint.name] ? at(run, ANGLES[joint.name], t) : 0;
    frames.set(joint.child, times(parent, times(joint.at, pose(joint.axis, angle, [0, 0, 0]))));
  }
  return frames;
}

/** The tip by the robot's own kinematics. */
function tipOf(frames) {
  const tip = frames.get('tip');
  return tip ? [tip[3], tip[7], tip[11]] : null;
}

/** Width of a run's path, px: of runs in one place all are seen, the last on top. */
const wayWidth = (number) => 2.6 + 2.4 * Math.min(state.group.runs.length - 1 - number, 3);

/** The tip's way, its error made larger: points three by three, and their times. */
function wayOf(run, factor) {
  const times = [...new Set(['x', 'y', 'z'].flatMap((axis) => Array.from((run.signals[`tip_${axis}_m`] || { t: [] }).t)))].sort((a, b) => a - b);
  const points = new Float32Array(3 * times.length);
  times.forEach((t, i) => {
    ['x', 'y', 'z'].forEach((axis, side) => {
      points[3 * i + side] = at(run, `tip_${axis}_m`, t) + (factor - 1) * at(run, `error_${axis}_m`, t);
    });
  });
  return { times: Float32Array.from(times), points };
}

for (const group of groups) for (const run of group.runs) run.robot = robotOf(run.urdf);
