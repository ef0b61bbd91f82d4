// The data of the page: decoded once, read at any time.

const { sections, groups } = JSON.parse(document.getElementById('data').textContent);

/** Numbers from base64 of little-endian f32. */
function numbers(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Float32Array(bytes.buffer);
}

/** A signal: its times, then its values. */
function decoded(text) {
  const all = numbers(text);
  const count = all.length / 2;
  return { t: all.subarray(0, count), v: all.subarray(count) };
}

for (const group of groups) {
  for (const run of group.runs) {
    run.path = numbers(run.path);
    for (const name of Object.keys(run.signals)) run.signals[name] = decoded(run.signals[name]);
    run.isShown = true;
  }
}

/** Number of the last element that is not after a time; -1 before the first. */
function before(times, t) {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle + 1; else high = middle;
  }
  return low - 1;
}

/** Value of a run's signal at a time, on the line between its points; 0 for one that is zero throughout. */
function at(run, name, t) {
  const signal = run.signals[name];
  if (!signal) return 0;
  const i = before(signal.t, t);
  if (i < 0) return signal.v[0];
  if (i + 1 >= signal.t.length) return signal.v[signal.t.length - 1];
  const part = (t - signal.t[i]) / (signal.t[i + 1] - signal.t[i] || 1);
  return signal.v[i] + part * (signal.v[i + 1] - signal.v[i]);
}

/** A number with four significant digits, as the command prints it. */
function short(value) {
  if (!Number.isFinite(value)) return '-';
  const size = Math.abs(value);
  if (size < 1e-12) return '0';
  if (size < 1e-3 || size >= 1e5) return value.toExponential(2);
  return value.toFixed(Math.max(0, 3 - Math.floor(Math.log10(size))));
}

const theme = () => document.documentElement.dataset.theme;
const colorOf = (run) => run.color[theme()];
const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/** An element with properties and children. */
function element(tag, properties, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}
