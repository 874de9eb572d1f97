// Runs in a report in headless Chromium: uses every plot as a reader would and writes what happened into the page.
window.failures = [];
window.addEventListener('error', (event) => window.failures.push('error: ' + event.message));
const expect = (condition, what) => { if (!condition) window.failures.push(what); };
const result = {plots: 0, drawn: 0, zoomed: 0, reset: 0, hidden: 0, told: 0, rows: 0, pictures: 0, bands: 0, bodies: 0, shown: 0, turned: 0, undeformed: 0};

const painted = (canvas) => {
  const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let i = 3; i < data.length; i += 4) count += data[i] > 0;
  return count;
};
const pointer = (type, x, y) => new PointerEvent(type, {clientX: x, clientY: y, bubbles: true});

function usePlot(box) {
  const plot = JSON.parse(box.querySelector('script').textContent), name = plot.title;
  ++result.plots;
  expect(box.querySelector('svg').getBoundingClientRect().height > 50, name + ': no picture before');
  box.dispatchEvent(new PointerEvent('pointerenter'));
  const {chart} = box;
  expect(chart, name + ': no chart');
  if (!chart) return;
  result.drawn += painted(chart.canvas) > 500;
  const datasets = chart.data.datasets;
  for (const s of plot.series) {
    const own = datasets.filter((d) => d.series === plot.series.indexOf(s) && !d.band);
    const finite = s.x.filter((x, i) => x !== null && s.y[i] !== null).length;
    expect(own.length === 1 && own[0].data.filter((p) => p.x !== null && p.y !== null).length >= finite, name + ': points');
    // The axes show all of it.
    for (const [scale, values] of [[chart.scales.x, s.x], [chart.scales.y, s.y]]) {
      const given = scale === chart.scales.x ? plot.x_range : plot.y_range;
      if (given || plot.y_log) continue;
      const numbers = values.filter((v) => v !== null), slack = 1e-9 * (scale.max - scale.min);
      expect(Math.min(...numbers) >= scale.min - slack && Math.max(...numbers) <= scale.max + slack, name + ': cut off');
    }
    if (s.low) result.bands += datasets.filter((d) => d.band).length > 0;
  }

  // A rectangle from a quarter to three quarters of the plot.
  const box0 = chart.canvas.getBoundingClientRect(), area = chart.chartArea;
  const at = (part) => [box0.left + area.left + part * (area.right - area.left), box0.top + area.top + part * (area.bottom - area.top)];
  const before = [chart.scales.x.min, chart.scales.x.max];
  chart.canvas.dispatchEvent(pointer('pointerdown', ...at(0.25)));
  chart.canvas.dispatchEvent(pointer('pointermove', ...at(0.5)));
  window.dispatchEvent(pointer('pointerup', ...at(0.75)));
  const span = (scale) => plot.x_log ? Math.log(scale.max / scale.min) : scale.max - scale.min;
  const wanted = 0.5 * span({min: before[0], max: before[1]});
  result.zoomed += Math.abs(span(chart.scales.x) / wanted - 1) < 0.02;
  chart.canvas.dispatchEvent(new MouseEvent('dblclick'));
  result.reset += chart.scales.x.min === before[0] && chart.scales.x.max === before[1];

  const [item] = chart.legend.legendItems;
  if (item) {
    const {series} = datasets[item.datasetIndex];
    chart.options.plugins.legend.onClick(null, item, chart.legend);
    const all = datasets.map((d, i) => [d, chart.isDatasetVisible(i)]);
    result.hidden += all.every(([d, visible]) => visible === (d.series !== series));
    chart.options.plugins.legend.onClick(null, item, chart.legend);
    expect(chart.isDatasetVisible(item.datasetIndex), name + ': does not come back');
  } else {
    ++result.hidden;
  }

  // What a reader is told of the first point.
  const first = datasets.findIndex((d) => !d.band && !d.level), point = datasets[first].data.findIndex((p) => p.y !== null && !Number.isNaN(p.y));
  chart.tooltip.setActiveElements([{datasetIndex: first, index: point}], {x: 0, y: 0});
  chart.tooltip.update(true);
  result.told += chart.tooltip.body.length === 1 && chart.tooltip.body[0].lines[0].startsWith(datasets[first].label);

  const lines = box.plotCsv().trim().split('\n');
  const points = plot.series.reduce((sum, s) => sum + s.x.length, 0);
  expect(lines.length === points + 1, name + ': CSV of ' + lines.length + ' lines');
  result.rows += lines.length - 1;
}

function turnBody(box) {
  ++result.bodies;
  const body = JSON.parse(box.querySelector('script').textContent);
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

window.addEventListener('load', () => {
  try {
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
