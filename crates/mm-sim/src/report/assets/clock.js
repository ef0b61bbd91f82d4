// What the parts of the page share: the group shown, the time of the replay, the window of time, what is hidden.

const state = {
  group: groups[0],
  t: 0,
  begin: 0,
  end: 1,
  isPlaying: false,
  speed: 1,
  magnify: 1,
  isDesiredShown: true,
};

const listeners = { group: [], time: [], shown: [], window: [] };

/** Calls back when the group, the time, what is shown, or the window of time has changed. */
const on = (what, callback) => listeners[what].push(callback);
const tell = (what) => listeners[what].forEach((callback) => callback());

function setTime(t) {
  state.t = Math.min(Math.max(t, state.begin), state.end);
  tell('time');
}

function setGroup(group) {
  state.group = group;
  state.begin = Math.min(...group.runs.map((run) => run.begin_s));
  state.end = Math.max(...group.runs.map((run) => run.end_s), state.begin + 1e-6);
  state.t = state.begin;
  tell('group');
  tell('time');
}

let last = 0;
function step(now) {
  if (!state.isPlaying) return;
  setTime(state.t + (state.speed * Math.min(now - last, 100)) / 1000);
  last = now;
  if (state.t >= state.end) play(false); else requestAnimationFrame(step);
}

function play(isPlaying) {
  if (isPlaying && state.t >= state.end) setTime(state.begin);
  state.isPlaying = isPlaying;
  const button = document.getElementById('play');
  button.textContent = isPlaying ? '\u275a\u275a' : '\u25b6';
  button.setAttribute('aria-label', isPlaying ? 'Pause' : 'Play');
  if (isPlaying) {
    last = performance.now();
    requestAnimationFrame(step);
  }
}
