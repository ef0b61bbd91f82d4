// The scene on a plain canvas, where there is no WebGL: the same view, drawn from far to near.

class FlatScene {
  constructor(canvas) {
    this.pen = canvas.getContext('2d');
    this.canvas = canvas;
    this.point = new THREE.Vector3();
  }

  resize(width, height) {
    const ratio = Math.min(devicePixelRatio, 2);
    this.canvas.width = width * ratio;
    this.canvas.height = height * ratio;
    this.ratio = ratio;
    this.size = [width, height];
  }

  build() {
    this.ways = state.group.runs.map((run) => wayOf(run, state.magnify));
  }

  /** A point of the world on the canvas, and its depth; null behind the eye. */
  seen([x, y, z]) {
    const p = this.point.set(x, y, z).project(this.camera);
    return p.z < 1 ? [(0.5 + 0.5 * p.x) * this.size[0], (0.5 - 0.5 * p.y) * this.size[1], p.z] : null;
  }

  stroke(points, color, width, dash = []) {
    const { pen } = this;
    pen.beginPath();
    let isDown = false;
    for (const point of points) {
      const place = this.seen(point);
      if (place) {
        if (isDown) pen.lineTo(place[0], place[1]); else pen.moveTo(place[0], place[1]);
      }
      isDown = Boolean(place);
    }
    pen.setLineDash(dash);
    pen.lineWidth = width;
    pen.strokeStyle = color;
    pen.stroke();
  }

  floor() {
    const [low, high] = boundsOf(state.group);
    const side = Math.max(high[0] - low[0], high[1] - low[1]) > 12 ? 1 : 0.5;
    const ends = [0, 1].map((axis) => [Math.floor(low[axis] / side) - 1, Math.ceil(high[axis] / side) + 1]);
    // Cell by cell: what is behind the eye is left out, not the whole line.
    for (const along of [0, 1]) {
      const [from, to] = ends[along];
      const cells = Array.from({ length: to - from + 1 }, (_, k) => (from + k) * side);
      for (let i = ends[1 - along][0]; i <= ends[1 - along][1]; i += 1) {
        this.stroke(cells.map((value) => (along === 0 ? [value, i * side, 0] : [i * side, value, 0])), ink('floor'), 1);
      }
    }
  }

  /** Outlines of a link's shapes in the world: faces of a box, the sides of a cylinder as a strip. */
  faces(frame, body) {
    const place = times(frame, body.at);
    if (body.kind === 'box') {
      const [a, b, c] = body.size.map((size) => size / 2);
      const corner = (i) => moved(place, [i & 1 ? a : -a, i & 2 ? b : -b, i & 4 ? c : -c]);
      return [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]].map((face) => face.map(corner));
    }
    const ring = (z) => Array.from({ length: 16 }, (_, i) => {
      const angle = (i * Math.PI) / 8;
      return moved(place, [body.radius * Math.cos(angle), body.radius * Math.sin(angle), z]);
    });
    const [low, high] = [ring(-body.length / 2), ring(body.length / 2)];
    const sides = low.map((_, i) => [low[i], low[(i + 1) % 16], high[(i + 1) % 16], high[i]]);
    return [...sides, low, high];
  }

  robot(run) {
    const frames = framesOf(run, state.t);
    const all = [];
    for (const link of run.robot.links) {
      for (const body of link.shapes) for (const face of this.faces(frames.get(link.name) || IDENTITY, body)) all.push({ face, body });
    }
    const drawn = all
      .map(({ face, body }) => ({ places: face.map((point) => this.seen(point)), body }))
      .filter(({ places }) => places.every(Boolean))
      .map((one) => ({ ...one, depth: one.places.reduce((sum, place) => sum + place[2], 0) / one.places.length }))
      .sort((a, b) => b.depth - a.depth);
    for (const { places, body } of drawn) {
      this.pen.beginPath();
      places.forEach(([x, y], i) => (i ? this.pen.lineTo(x, y) : this.pen.moveTo(x, y)));
      this.pen.closePath();
      this.pen.setLineDash([]);
      this.pen.fillStyle = body.material === 'wheel' ? ink('wheel') : body.material === 'base' ? ink('body') : colorOf(run);
      this.pen.strokeStyle = ink('outline');
      this.pen.lineWidth = 0.6;
      this.pen.fill();
      this.pen.stroke();
    }
    const tip = tipOf(frames);
    const place = tip && this.seen(tip);
    if (place) {
      this.pen.beginPath();
      this.pen.arc(place[0], place[1], 4, 0, 2 * Math.PI);
      this.pen.fillStyle = ink('ink');
      this.pen.fill();
    }
  }

  draw(camera) {
    this.camera = camera;
    camera.updateMatrixWorld();
    this.pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    this.pen.clearRect(0, 0, ...this.size);
    this.floor();
    const three = (points, end) => Array.from({ length: end }, (_, i) => points.subarray(3 * i, 3 * i + 3));
    const path = state.group.runs[0].path;
    if (state.isDesiredShown) this.stroke(three(path, path.length / 3), ink('ink'), 1.4, [6, 5]);
    state.group.runs.forEach((run, i) => {
      if (!run.isShown) return;
      const { points, times: at_ } = this.ways[i];
      this.pen.globalAlpha = 0.3;
      this.stroke(three(points, at_.length), colorOf(run), 1.4);
      this.pen.globalAlpha = 1;
      this.stroke(three(points, before(at_, state.t) + 1), colorOf(run), wayWidth(i));
    });
    state.group.runs.filter((run) => run.isShown).forEach((run) => this.robot(run));
  }
}
