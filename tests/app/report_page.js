// Runs in a report in headless Chromium: uses every plot as a reader would and writes what happened into the page.
window.failures = [];
window.addEventListener('error', (event) => window.failures.push('error: ' + event.message));
const expect = (condition, what) => { if (!condition) window.failures.push(what); };
const result = {plots: 0, curves: 0, bars: 0, map: 0, spreads: 0, unusable: [], drawn: 0, zoomed: 0, reset: 0, hidden: 0, told: 0, rows: 0, pictures: 0, bands: 0, bodies: 0, shown: 0, turned: 0, undeformed: 0};

const painted = (canvas) => {
  const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let i = 3; i < data.length; i += 4) count += data[i] > 0;
  return count;
};
const pointer = (type, x, y) => new PointerEvent(type, {clientX: x, clientY: y, bubbles: true});

/// Every point of the marks is there; the axes are those of the picture.
function checkMarks(panel, chart, name) {
  const datasets = chart.data.datasets.filter((d) => d.x && !d.band).reverse();
  expect(datasets.length === panel.sets.length, name + ': marks');
  panel.sets.forEach((s, i) => {
    const finite = s.x.filter((x, k) => x !== null && s.y[k] !== null).length;
    expect(datasets[i].data.filter((p) => p.x !== null && p.y !== null).length === finite, name + ': points');
    if (s.low) result.bands += chart.data.datasets.some((d) => d.band && d.group === s.group);
  });
  for (const scale of [chart.scales.x, chart.scales.y]) {
    const labels = scale.ticks.map((t) => t.label).filter((label) => label !== '');
    expect(new Set(labels).size === labels.length, name + ': equal labels of an axis: ' + labels.join(' '));
  }
  for (const [scale, {range}] of [[chart.scales.x, panel.x], [chart.scales.y, panel.y]])
    expect(scale.min === Math.min(...range) && scale.max === Math.max(...range), name + ': other axes than in the picture');
}

/// Cells have the colours of their values, where the canvas shows them.
function checkCells(plot, chart, name) {
  const {x, y} = chart.scales, ratio = chart.currentDevicePixelRatio, {ctx} = chart;
  let seen = 0, right = 0;
  for (const [x1, x2, y1, y2, value] of chart.data.panel.cells) {
    const [left, end] = [x1, x2].map((v) => x.getPixelForValue(v)), [low, top] = [y1, y2].map((v) => y.getPixelForValue(v));
    if (end - left < 6 || low - top < 6 || value === null) continue;
    if (left < chart.chartArea.left || end > chart.chartArea.right) continue;
    ++seen;
    const at = [left + 2, top + 2].map((v) => Math.round(v * ratio));
    const [r, g, b] = ctx.getImageData(...at, 1, 1).data;
    const {range: [least, most], colours} = plot.scale, steps = colours.length;
    const step = Math.min(steps - 1, Math.max(0, Math.floor((value - least) / (most - least) * steps)));
    const wanted = [1, 3, 5].map((i) => parseInt(colours[step].slice(i, i + 2), 16));
    right += Math.abs(r - wanted[0]) + Math.abs(g - wanted[1]) + Math.abs(b - wanted[2]) < 12;
  }
  // A line may cross some of them.
  expect(right >= 0.8 * seen, name + `: ${right} of ${seen} cells have their colour`);
}

const kindOf = (plot) => (plot.scale ? 'map' : plot.panels[0].y.names ? 'bars' : plot.panels[0].x.names ? 'spreads' : 'curves');
const rowsOf = (plot) => plot.panels.reduce((sum, p) => sum + (plot.scale ? p.cells.length : p.sets.reduce((n, s) => n + (s.label ? s.x.length : 0), 0)), 0);

/// How many of its charts can be used in that way.
const good = {drawn: 0, zoomed: 0, reset: 0, hidden: 0, told: 0};

function useChart(plot, chart, name) {
  const {panel} = chart.data;
  good.drawn += painted(chart.canvas) > 500;
  const datasets = chart.data.datasets;
  checkMarks(panel, chart, name);
  if (plot.scale) checkCells(plot, chart, name);

  // A rectangle from a quarter to three quarters of the plot.
  const box0 = chart.canvas.getBoundingClientRect(), area = chart.chartArea;
  const at = (part) => [box0.left + area.left + part * (area.right - area.left), box0.top + area.top + part * (area.bottom - area.top)];
  const before = [chart.scales.x.min, chart.scales.x.max];
  chart.canvas.dispatchEvent(pointer('pointerdown', ...at(0.25)));
  chart.canvas.dispatchEvent(pointer('pointermove', ...at(0.5)));
  window.dispatchEvent(pointer('pointerup', ...at(0.75)));
  const span = (scale) => panel.x.log ? Math.log(scale.max / scale.min) : scale.max - scale.min;
  const wanted = 0.5 * span({min: before[0], max: before[1]});
  good.zoomed += Math.abs(span(chart.scales.x) / wanted - 1) < 0.02;
  chart.canvas.dispatchEvent(new MouseEvent('dblclick'));
  good.reset += chart.scales.x.min === before[0] && chart.scales.x.max === before[1];

  const item = chart.legend.legendItems[0];
  if (item) {
    const {group} = datasets[item.datasetIndex];
    chart.options.plugins.legend.onClick(null, item, chart.legend);
    const all = datasets.map((d, i) => [d, chart.isDatasetVisible(i)]);
    good.hidden += all.every(([d, visible]) => visible === (d.group !== group));
    chart.options.plugins.legend.onClick(null, item, chart.legend);
    expect(chart.isDatasetVisible(item.datasetIndex), name + ': does not come back');
  } else {
    ++good.hidden;
  }

  // What a reader is told at a point; of a map, at the middle of a cell.
  const first = datasets.findIndex((d) => d.label && d.data.some((p) => p.y !== null && !Number.isNaN(p.y)));
  const shown = datasets[first].data.map((p, i) => [p, i]).filter(([p]) => p.y !== null && p.x > chart.scales.x.min && p.x < chart.scales.x.max);
  const [point, index] = shown.length > 0 ? shown[Math.floor(shown.length / 2)] : [datasets[first].data[0], 0];
  const event = {x: chart.scales.x.getPixelForValue(point.x), y: chart.scales.y.getPixelForValue(point.y)};
  const found = Chart.Interaction.modes.pointed(chart, event);
  expect(found.length === 1 && (!plot.scale || found[0].index === index), name + ': nothing at the pointer');
  chart.tooltip.setActiveElements([{datasetIndex: first, index}], {x: 0, y: 0});
  chart.tooltip.update(true);
  const line = chart.tooltip.body.length === 1 ? chart.tooltip.body[0].lines[0] : '';
  const head = datasets[first].label;
  good.told += line.startsWith(head + ': ') && line.length > head.length + 2;
}

function usePlot(box) {
  const plot = annulus.numbers(box), name = plot.title || kindOf(plot);
  ++result.plots;
  ++result[kindOf(plot)];
  expect(box.querySelector('svg').getBoundingClientRect().height > 30, name + ': no picture before');
  box.dispatchEvent(new PointerEvent('pointerenter'));
  const charts = box.charts || [];
  expect(charts.length === plot.panels.length, name + `: ${charts.length} charts`);
  for (const what in good) good[what] = 0;
  for (const chart of charts) useChart(plot, chart, name);
  for (const what in good) {
    result[what] += charts.length > 0 && good[what] === charts.length;
    if (good[what] !== charts.length) result.unusable.push(`${name}: ${what}`);
  }

  const lines = box.plotCsv().trim().split('\n');
  expect(lines.length === rowsOf(plot) + 1, name + ': CSV of ' + lines.length + ' lines');
  result.rows += lines.length - 1;
}

function turnBody(box) {
  ++result.bodies;
  const body = box.body();
  const vertices = body.place_mm.length / 3;
  expect(vertices > 50 && body.displacement_mm.length === 3 * vertices && body.stress_MPa.length === vertices, 'sizes');
  expect(body.faces.length % 4 === 0 && Math.max(...body.faces) < vertices, 'faces');
  box.querySelector('button.turn').click();
  const {view} = box;
  expect(view, 'no view: ' + (box.querySelector('button.turn') || {}).textContent);
  if (!view) return;
  const picture = () => view.renderer.domElement.toDataURL();
  const first = picture();
  const gl = view.renderer.getContext(), pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
  gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let coloured = 0;
  for (let i = 0; i < pixels.length; i += 4) coloured += Math.min(pixels[i], pixels[i + 1], pixels[i + 2]) < 250;
  result.shown += coloured > 0.1 * pixels.length / 4;
  view.camera.position.add(new THREE.Vector3(50, 20, 0));
  view.controls.update();
  result.turned += picture() !== first;
  view.slider.value = 0;
  view.slider.dispatchEvent(new Event('input'));
  const at = view.geometry.getAttribute('position').array;
  result.undeformed += at.every((x, i) => Math.abs(x - body.place_mm[i]) < 1e-4);
}

/// Words of a picture that reach beyond it, which a browser cuts off.
function croppedWords() {
  const cropped = [];
  for (const svg of document.querySelectorAll('svg[role=img]')) {
    const whole = svg.getBoundingClientRect();
    if (whole.width === 0) continue;
    for (const words of svg.querySelectorAll('text')) {
      const {left, right, top, bottom} = words.getBoundingClientRect(), slack = 2;
      if (left < whole.left - slack || right > whole.right + slack || top < whole.top - slack || bottom > whole.bottom + slack)
        cropped.push(`${svg.getAttribute('aria-label').slice(0, 60)}: "${words.textContent}"`);
    }
  }
  return cropped;
}

/// What axe-core finds, where the page has it.
async function inaccessible() {
  if (!window.axe) return ['axe-core is not there'];
  const {violations} = await axe.run(document, {resultTypes: ['violations']});
  return violations.map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.html.slice(0, 120)).join(' | ')}`);
}

window.addEventListener('load', async () => {
  try {
    const folds = [...document.querySelectorAll('details.section')];
    result.folds = folds.length;
    result.packed = document.querySelectorAll('script.picture').length;
    result.wide = document.documentElement.scrollWidth > document.documentElement.clientWidth;
    result.screens = document.querySelector('main').scrollHeight / 900;
    folds.forEach(annulus.open);
    for (const select of document.querySelectorAll('select')) {
      select.value = '';
      select.dispatchEvent(new Event('change'));
    }
    expect(document.querySelectorAll('script.picture').length === 0, 'pictures are still packed');
    // One planet alone, in pictures; then all again.
    const planet = document.querySelector('select[data-choose=line]');
    if (planet) {
      const shown = () => [...document.querySelectorAll('[data-line^="planet "]')].filter((g) => g.style.display !== 'none');
      const all = shown().length;
      planet.value = 'planet 2';
      planet.dispatchEvent(new Event('change'));
      const left = shown();
      result.one_planet = left.length > 0 && left.length < all && left.every((g) => g.dataset.line === 'planet 2');
      planet.value = '';
      planet.dispatchEvent(new Event('change'));
      expect(shown().length === all, 'planets do not come back');
    }
    result.cropped = croppedWords();
    if (window.check_access) result.inaccessible = await inaccessible();
    for (const box of document.querySelectorAll('.plot')) usePlot(box);
    for (const box of document.querySelectorAll('.view3d')) turnBody(box);
    const swinging = document.querySelectorAll('.swing');
    result.swinging = [...swinging].filter((g) => getComputedStyle(g).animationName === 'swing').length;
    result.pictures = document.querySelectorAll('svg').length;
    result.fetched = performance.getEntriesByType('resource').length;
  } catch (error) {
    window.failures.push(String(error.stack));
  }
  result.failures = window.failures;
  document.body.innerHTML = '<pre id="result">' + JSON.stringify(result).replaceAll('<', '') + '</pre>';
});
