// The controls, and the beginning.

const byId = (id) => document.getElementById(id);
const slider = byId('time');
const clock = byId('clock');

/** A button that is on or off. */
function toggle(text, isOn, change) {
  const button = element('button', { type: 'button', textContent: text });
  button.setAttribute('aria-pressed', String(isOn));
  button.addEventListener('click', () => {
    const next = button.getAttribute('aria-pressed') !== 'true';
    button.setAttribute('aria-pressed', String(next));
    change(next);
    tell('shown');
  });
  return button;
}

function showToggles() {
  const runs = state.group.runs.map((run) => {
    const button = toggle(run.name, run.isShown, (isShown) => { run.isShown = isShown; });
    const mark = element('span', { className: 'swatch' });
    mark.style.background = colorOf(run);
    button.prepend(mark);
    return button;
  });
  const desired = toggle('desired', state.isDesiredShown, (isShown) => { state.isDesiredShown = isShown; });
  desired.prepend(element('span', { className: 'swatch dashed' }));
  byId('toggles').replaceChildren(...runs, desired);
}

/** The colours of the runs in texts of the page. */
function paintNames() {
  const colors = new Map(groups.flatMap((group) => group.runs).map((run) => [run.name, colorOf(run)]));
  for (const node of document.querySelectorAll('[data-run]')) node.parentElement.style.borderInlineStartColor = colors.get(node.dataset.run) || '';
}

slider.addEventListener('input', () => setTime(Number(slider.value)));
slider.addEventListener('keydown', (event) => {
  // Steps of the slider: a hundredth of what the plots show, ten times that with page keys.
  const small = (window_.end - window_.begin) / 100;
  const steps = { ArrowLeft: -small, ArrowDown: -small, ArrowRight: small, ArrowUp: small, PageDown: -10 * small, PageUp: 10 * small };
  if (steps[event.key] === undefined) return;
  event.preventDefault();
  setTime(state.t + steps[event.key]);
});
byId('play').addEventListener('click', () => play(!state.isPlaying));
byId('speed').addEventListener('change', (event) => { state.speed = Number(event.target.value); });
byId('magnify').addEventListener('change', (event) => { state.magnify = Number(event.target.value); rebuild(); });
byId('whole').addEventListener('click', wholeRun);
document.querySelectorAll('[data-view]').forEach((button) => button.addEventListener('click', () => view.all(button.dataset.view)));
byId('follow').addEventListener('click', (event) => {
  const isOn = event.currentTarget.getAttribute('aria-pressed') !== 'true';
  event.currentTarget.setAttribute('aria-pressed', String(isOn));
  view.setFollowing(isOn);
  if (!isOn) view.all();
});
byId('webgl').addEventListener('click', (event) => {
  makeScene(event.currentTarget.getAttribute('aria-pressed') !== 'true', true);
  rebuild();
});
if (byId('group')) byId('group').addEventListener('change', (event) => setGroup(groups[Number(event.target.value)]));
document.addEventListener('keydown', (event) => {
  const isFree = event.target === document.body || event.target.closest('#scene, .plot');
  if (event.key === ' ' && isFree) {
    event.preventDefault();
    play(!state.isPlaying);
  }
});

on('group', () => {
  Object.assign(slider, { min: state.begin, max: state.end });
  showToggles();
});
on('time', () => {
  slider.value = state.t;
  clock.textContent = `${state.t.toFixed(2)} s`;
  slider.setAttribute('aria-valuetext', `${state.t.toFixed(2)} seconds`);
});
addEventListener('themechange', () => { showToggles(); paintNames(); });
// Plots and scene take the width that they get, on paper too.
let isFitting = false;
new ResizeObserver(() => {
  if (isFitting) return;
  isFitting = true;
  requestAnimationFrame(() => { isFitting = false; fitScene(); fitPlots(); });
}).observe(document.querySelector('main'));
addEventListener('beforeprint', () => { play(false); drawScene(); });

makeScene(true);
setGroup(groups[0]);
paintNames();
document.documentElement.dataset.ready = 'true';
