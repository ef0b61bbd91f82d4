// The replay: the scene, drawn when something has changed, and the runs' values beside it.

const place = document.getElementById('scene');
const view = new View(place);
let scene = null;
let isStale = false;

/** The scene in WebGL, where there is a graphics card or `isForced`, or on a plain canvas. */
function makeScene(isSolid, isForced = false) {
  const canvas = element('canvas', {});
  canvas.setAttribute('aria-hidden', 'true');
  place.replaceChildren(canvas);
  const solid = isSolid ? SolidScene.on(canvas, isForced) : null;
  if (solid) {
    scene = solid;
    canvas.addEventListener('webglcontextlost', () => { makeScene(false); rebuild(); });
  } else {
    // A canvas that was asked for WebGL gives nothing else.
    const plain = element('canvas', {});
    plain.setAttribute('aria-hidden', 'true');
    place.replaceChildren(plain);
    scene = new FlatScene(plain);
  }
  place.dataset.renderer = solid ? 'webgl' : 'canvas';
  document.getElementById('webgl').setAttribute('aria-pressed', String(Boolean(solid)));
  fitScene();
}

function fitScene() {
  const { clientWidth: width, clientHeight: height } = place;
  if (!width || !height) return;
  view.camera.aspect = width / height;
  view.camera.updateProjectionMatrix();
  scene.resize(width, height);
  stale();
}

function stale() {
  if (isStale) return;
  isStale = true;
  requestAnimationFrame(drawScene);
}

/** Draws now; the first robot's tip by its kinematics is left where a test can read it. */
function drawScene() {
  isStale = false;
  if (!scene) return;
  scene.draw(view.camera);
  const tip = tipOf(framesOf(state.group.runs[0], state.t));
  place.dataset.tip = tip ? tip.map((value) => value.toFixed(4)).join(' ') : '';
  place.dataset.time = state.t.toFixed(3);
}

function rebuild() {
  scene.build();
  stale();
}

/** Cards with what each run does at the time of the replay. */
function showCards() {
  const cards = state.group.runs.map((run) => {
    const value = (name) => {
      const dd = element('dd', {});
      return [element('div', {}, element('dt', { textContent: name }), dd), dd];
    };
    const [error, errorValue] = value('error of the tip');
    const [speed, speedValue] = value('forward speed');
    const [tip, tipValue] = value('tip');
    const head = element('h3', { textContent: run.name });
    const card = element('article', { className: 'card' }, head, element('dl', {}, error, speed, tip));
    card.style.borderInlineStartColor = colorOf(run);
    run.card = { card, errorValue, speedValue, tipValue };
    return card;
  });
  document.getElementById('readout').replaceChildren(...cards);
}

function updateCards() {
  for (const run of state.group.runs) {
    const { card, errorValue, speedValue, tipValue } = run.card;
    card.classList.toggle('off', !run.isShown);
    card.style.borderInlineStartColor = colorOf(run);
    errorValue.textContent = `${short(1e3 * at(run, 'error_norm_m', state.t))} mm`;
    speedValue.textContent = `${at(run, 'forward_m_s', state.t).toFixed(3)} m/s`;
    tipValue.textContent = `${['x', 'y', 'z'].map((axis) => at(run, `tip_${axis}_m`, state.t).toFixed(3)).join(', ')} m`;
  }
}

view.controls.addEventListener('change', stale);
on('group', () => { showCards(); rebuild(); view.setFollowing(view.isFollowing); view.all(); });
on('time', () => { view.follow(); updateCards(); stale(); });
on('shown', () => { updateCards(); stale(); });
addEventListener('themechange', () => { if (scene) { rebuild(); updateCards(); drawScene(); } });
