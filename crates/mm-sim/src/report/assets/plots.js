// The plots: one for each signal, a curve for each run, linked in time with one another and with the replay.

const FLOOR_MM = 1e-4;
const HEIGHT = 190;
let plots = [];

/** Data of a plot: one time axis for all curves, gaps where a curve has no point there. */
function tableOf(plot, runs) {
  const curves = [];
  for (const run of runs) {
    const signal = run.signals[plot.signal];
    if (signal) curves.push({ run, signal, isDesired: false });
  }
  const guided = plot.desired && runs.find((run) => run.signals[plot.desired]);
  // What is desired of the tip is the same for all runs; what a law asks of the velocities is its own.
  const guides = guided ? (plot.desired.startsWith('reference') ? [guided] : runs.filter((run) => run.signals[plot.desired])) : [];
  for (const run of guides) curves.push({ run, signal: run.signals[plot.desired], isDesired: true });
  const scaled = (values) => Array.from(values, (v) => (plot.is_logarithmic ? Math.max(v * plot.factor, FLOOR_MM) : v * plot.factor));
  const tables = curves.map(({ signal }) => [Array.from(signal.t), scaled(signal.v)]);
  return { curves, data: tables.length ? uPlot.join(tables) : [[]] };
}

/** Colours of axes and grid, asked for at every drawing, so that they follow the theme. */
const axis = (more) => ({
  stroke: () => ink('muted'),
  grid: { stroke: () => ink('grid'), width: 1 },
  ticks: { stroke: () => ink('grid'), width: 1, size: 4 },
  font: '11px system-ui, sans-serif',
  labelFont: '11px system-ui, sans-serif',
  labelGap: 0,
  ...more,
});

const tick = (value) => (value === 0 ? '0' : Math.abs(value) < 1e-3 || Math.abs(value) >= 1e5 ? value.toExponential(0) : String(+value.toPrecision(4)));

/** A value on an axis with as many digits as its step has. */
function stepped(value, step) {
  // A step of 2.5 has one digit more than its power of ten.
  let digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  if (Math.abs(step * 10 ** digits - Math.round(step * 10 ** digits)) > 1e-6) digits += 1;
  return digits > 5 || Math.abs(value) >= 1e5 ? tick(value) : value.toFixed(digits);
}

function optionsOf(plot, curves, width) {
  const label = plot.unit ? `${plot.title} (${plot.unit})` : plot.title;
  const several = state.group.runs.length > 1;
  return {
    width,
    height: HEIGHT,
    legend: { show: false },
    cursor: { sync: { key: 'time', setSeries: false }, drag: { x: true, y: false, setScale: false }, points: { size: 5 } },
    scales: {
      x: { time: false, range: (u, low, high) => windowOf(low, high) },
      y: plot.is_logarithmic ? { distr: 3 } : { range: (u, low, high) => spanOf(low, high, plot) },
    },
    axes: [
      axis({ label: 'time (s)', labelSize: 14, size: 26 }),
      axis({
        label,
        labelSize: 16,
        size: 52,
        values: plot.is_logarithmic ? (u, values) => values.map((v) => (v && Math.abs(Math.log10(v) % 1) < 1e-9 ? tick(v) : '')) : (u, values, number, space, step) => values.map((v) => stepped(v, step)),
      }),
    ],
    series: [
      {},
      ...curves.map(({ run, isDesired }) => ({
        label: run.name,
        stroke: () => (isDesired ? (several && !plot.desired.startsWith('reference') ? colorOf(run) : ink('ink')) : colorOf(run)),
        width: isDesired ? 1 : 1.4,
        dash: isDesired ? [5, 4] : undefined,
        spanGaps: true,
        points: { show: false },
        show: isDesired ? state.isDesiredShown && run.isShown : run.isShown,
      })),
    ],
    hooks: {
      setSelect: [(u) => {
        const { left, width: wide } = u.select;
        if (wide > 3) setWindow(u.posToVal(left, 'x'), u.posToVal(left + wide, 'x'));
        u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
      }],
      setCursor: [(u) => read(u)],
      setSize: [(u) => mark(u)],
      draw: [(u) => mark(u)],
    },
  };
}

/** Least range of a position, m: a height that is held should look so, errors have plots of their own. */
const LEAST_POSITION_M = 0.1;

/** A range with some air; of a constant, one about it. */
function spanOf(low, high, plot) {
  if (low == null || high == null) return [-1, 1];
  const isPosition = plot.desired && plot.desired.startsWith('reference');
  if (isPosition && high - low < LEAST_POSITION_M) return [-1, 1].map((side) => 0.5 * (low + high) + 0.5 * side * LEAST_POSITION_M);
  const air = high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)) ? 0.06 * (high - low) : Math.max(0.1 * Math.abs(high), 1e-3);
  return [low - air, high + air];
}

const window_ = { begin: 0, end: 1 };
const windowOf = (low, high) => (low == null || high == null ? [window_.begin, window_.end] : [low, high]);

/** Shows a part of the run in all plots. */
function setWindow(begin, end) {
  const least = 1e-3 * (state.end - state.begin);
  const wide = Math.max(end - begin, least);
  window_.begin = Math.min(Math.max(begin, state.begin), state.end - least);
  window_.end = Math.min(window_.begin + wide, state.end);
  plots.forEach(({ u }) => u.setScale('x', { min: window_.begin, max: window_.end }));
  document.getElementById('plot-list').dataset.window = `${window_.begin.toFixed(3)} ${window_.end.toFixed(3)}`;
  tell('window');
}

const wholeRun = () => setWindow(state.begin, state.end);

function zoom(factor) {
  const middle = state.t > window_.begin && state.t < window_.end ? state.t : 0.5 * (window_.begin + window_.end);
  setWindow(middle - (middle - window_.begin) * factor, middle + (window_.end - middle) * factor);
}

function shift(part) {
  const by = part * (window_.end - window_.begin);
  const room = by < 0 ? Math.max(by, state.begin - window_.begin) : Math.min(by, state.end - window_.end);
  setWindow(window_.begin + room, window_.end + room);
}

const KEYS = {
  '+': () => zoom(0.5),
  '=': () => zoom(0.5),
  '-': () => zoom(2),
  ArrowLeft: () => shift(-0.25),
  ArrowRight: () => shift(0.25),
  0: wholeRun,
  Home: wholeRun,
};

/** The line at the time of the replay. */
function mark(u) {
  const plot = u.shown;
  if (!plot) return;
  const x = u.valToPos(state.t, 'x');
  plot.line.style.transform = `translateX(${x}px)`;
  plot.line.hidden = !(x >= 0 && x <= u.over.clientWidth);
}

/** The values below the pointer, else those at the time of the replay. */
function read(u) {
  const plot = u.shown;
  if (!plot) return;
  const { left, idx } = u.cursor;
  const t = left >= 0 && idx != null ? u.posToVal(left, 'x') : state.t;
  const parts = plot.curves
    .filter(({ run, isDesired }) => run.isShown && !isDesired)
    .map(({ run }) => {
      const value = element('span', { textContent: short(at(run, plot.plot.signal, t) * plot.plot.factor) });
      value.style.color = colorOf(run);
      return value;
    });
  plot.values.replaceChildren(`${t.toFixed(2)} s`, ...parts);
}

function add(plot, place) {
  const { curves, data } = tableOf(plot, state.group.runs);
  if (!curves.some(({ isDesired }) => !isDesired)) return;
  const values = element('div', { className: 'values' });
  const name = plot.unit ? `${plot.title} in ${plot.unit}` : plot.title;
  const body = element('div', { className: 'canvas' });
  const box = element('figure', { className: 'plot', tabIndex: 0 }, element('figcaption', {}, element('b', { textContent: plot.title }), values), body);
  box.setAttribute('role', 'group');
  box.setAttribute('aria-label', `Plot of ${name} over time`);
  place.append(box);
  const u = new uPlot(optionsOf(plot, curves, Math.max(body.clientWidth, 200)), data, body);
  const line = element('div', { className: 'now' });
  u.over.append(line);
  u.shown = { plot, curves, values, line };
  box.dataset.points = String(Math.max(...curves.map(({ signal }) => signal.t.length)));
  box.dataset.curves = String(curves.length);
  box.addEventListener('keydown', (event) => {
    if (KEYS[event.key] && !event.ctrlKey && !event.metaKey && !event.altKey) {
      event.preventDefault();
      KEYS[event.key]();
    }
  });
  let pressed = 0;
  u.over.addEventListener('mousedown', (event) => { pressed = event.clientX; });
  u.over.addEventListener('click', (event) => {
    if (Math.abs(event.clientX - pressed) < 4) setTime(u.posToVal(event.clientX - u.over.getBoundingClientRect().left, 'x'));
  });
  u.over.addEventListener('dblclick', wholeRun);
  plots.push({ u, box, body, curves });
}

function showPlots() {
  plots.forEach(({ u }) => u.destroy());
  plots = [];
  Object.assign(window_, { begin: state.begin, end: state.end });
  const list = document.getElementById('plot-list');
  list.replaceChildren();
  for (const section of sections) {
    const place = element('div', { className: 'grid' });
    const part = element('div', { className: 'plots' }, element('h3', { textContent: section.title }), place);
    list.append(part);
    section.plots.forEach((plot) => add(plot, place));
    if (!place.children.length) part.remove();
  }
  wholeRun();
}

/** Shows and hides curves as the buttons say. */
function updateShown() {
  for (const { u, curves } of plots) {
    curves.forEach(({ run, isDesired }, i) => {
      const isShown = run.isShown && (!isDesired || state.isDesiredShown);
      if (u.series[i + 1].show !== isShown) u.setSeries(i + 1, { show: isShown });
    });
    read(u);
  }
}

function fitPlots() {
  for (const { u, body } of plots) if (body.clientWidth > 0) u.setSize({ width: body.clientWidth, height: HEIGHT });
}

on('group', showPlots);
on('shown', updateShown);
on('time', () => plots.forEach(({ u }) => { mark(u); read(u); }));
addEventListener('themechange', () => plots.forEach(({ u }) => u.redraw(false)));
