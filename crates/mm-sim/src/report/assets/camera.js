// The view of the scene, the same for both ways of drawing it: z is up, as in the world of the robot.

const DIRECTIONS = { space: [-0.75, -1.3, 0.85], above: [0, -1e-3, 1], side: [0, -1, 0.12] };

class View {
  constructor(place) {
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.01, 500);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, place);
    // The wheel scrolls the page until the scene has the focus.
    this.controls.enableZoom = false;
    this.isFollowing = false;
    place.addEventListener('focus', () => { this.controls.enableZoom = true; });
    place.addEventListener('blur', () => { this.controls.enableZoom = false; });
    place.addEventListener('keydown', (event) => this.key(event));
    this.direction = 'space';
  }

  key(event) {
    const turn = 0.1;
    const keys = {
      ArrowLeft: () => this.controls.rotateLeft(turn),
      ArrowRight: () => this.controls.rotateLeft(-turn),
      ArrowUp: () => this.controls.rotateUp(turn),
      ArrowDown: () => this.controls.rotateUp(-turn),
      '+': () => this.controls.dollyIn(1.15),
      '=': () => this.controls.dollyIn(1.15),
      '-': () => this.controls.dollyOut(1.15),
      0: () => this.all(this.direction),
    };
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.key]();
  }

  /** Looks at all paths from a side. */
  all(direction = this.direction) {
    this.direction = direction;
    const [low, high] = boundsOf(state.group);
    const middle = low.map((value, i) => 0.5 * (value + high[i]));
    const to = DIRECTIONS[direction];
    const size = Math.hypot(...to);
    const corners = Array.from({ length: 8 }, (_, i) => [0, 1, 2].map((axis) => ((i >> axis) & 1 ? high : low)[axis]));
    let distance = Math.hypot(...low.map((value, i) => high[i] - value));
    // As near as the corners allow: what they take of the window says how far off the eye has to be.
    for (let round = 0; round < 6; round += 1) {
      this.controls.target.set(...middle);
      this.camera.position.set(...middle.map((value, i) => value + (distance * to[i]) / size));
      this.controls.maxDistance = 20 * distance;
      this.controls.update();
      this.camera.updateMatrixWorld();
      const taken = corners.map((corner) => new THREE.Vector3(...corner).project(this.camera));
      distance *= Math.min(Math.max(...taken.map((p) => Math.max(Math.abs(p.x), Math.abs(p.y) * 1.06)), 0.1), 10) ** 0.9;
    }
  }

  /** Moves with the first robot that is shown. */
  follow() {
    const run = state.group.runs.find((other) => other.isShown);
    if (!this.isFollowing || !run) return;
    const place = ['x_m', 'y_m'].map((name) => at(run, name, state.t));
    const by = this.last ? place.map((value, i) => value - this.last[i]) : [0, 0];
    this.last = place;
    for (const point of [this.controls.target, this.camera.position]) {
      point.x += by[0];
      point.y += by[1];
    }
    this.controls.update();
  }

  /** Starts or stops moving along; close to the robot when it starts. */
  setFollowing(isFollowing) {
    this.isFollowing = isFollowing;
    this.last = null;
    const run = state.group.runs.find((other) => other.isShown);
    if (!isFollowing || !run) return;
    const target = [at(run, 'x_m', state.t), at(run, 'y_m', state.t), 0.35];
    const away = this.camera.position.clone().sub(this.controls.target).normalize().multiplyScalar(3.2);
    this.controls.target.set(...target);
    this.camera.position.set(...target).add(away);
    this.follow();
  }
}

/** Corners of the box that holds the paths and bases of a group, the floor included. */
function boundsOf(group) {
  const low = [Infinity, Infinity, 0];
  const high = [-Infinity, -Infinity, 0.5];
  const take = (axis, values) => {
    for (const value of values) {
      low[axis] = Math.min(low[axis], value);
      high[axis] = Math.max(high[axis], value);
    }
  };
  for (const run of group.runs) {
    ['x', 'y', 'z'].forEach((axis, side) => {
      take(side, (run.signals[`tip_${axis}_m`] || { v: [0] }).v);
      take(side, run.path.filter((_, i) => i % 3 === side));
    });
    ['x_m', 'y_m'].forEach((name, axis) => take(axis, (run.signals[name] || { v: [0] }).v));
  }
  return [low.map((v) => v - 0.15), high.map((v) => v + 0.15)];
}
