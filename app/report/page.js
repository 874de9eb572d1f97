// What makes the plots of a report interactive. The drawing is Chart.js; a plot stays the picture it is until someone
// points at it, and on paper.
(() => {
  'use strict';
  if (typeof Chart === 'undefined') return;

  const grey = '#777';
  const text = (x) =>
    x !== 0 && (Math.abs(x) >= 1e6 || Math.abs(x) < 1e-3) ? x.toExponential(4) : String(Number(x.toPrecision(6)));
  const range = (numbers) =>
    numbers.reduce(([a, b], v) => (Number.isFinite(v) ? [Math.min(a, v), Math.max(b, v)] : [a, b]), [Infinity, -Infinity]);

  /// The sets of points of a plot; a band is a pair of its own, hidden with its series.
  function datasets(plot) {
    const sets = [];
    plot.series.forEach((s, index) => {
      const at = (y) => s.x.map((x, i) => ({x, y: y[i]}));
      const common = {series: index, borderColor: s.colour, backgroundColor: s.colour, pointHoverRadius: 4};
      if (s.low) {
        const edge = {...common, band: true, showLine: true, borderWidth: 0, pointRadius: 0, pointHitRadius: 0};
        sets.push({...edge, label: '', data: at(s.low)});
        sets.push({...edge, label: '', data: at(s.high), fill: '-1', backgroundColor: s.colour + '29'});
      }
      const stems = s.style === 'bars';
      const data = stems ? at(s.y).flatMap((p) => [{x: p.x, y: 0}, p, {x: p.x, y: NaN}]) : at(s.y);
      sets.push({
        ...common, data, label: s.label || plot.title, unnamed: !s.label, showLine: s.style !== 'dots', borderWidth: 1.6,
        borderDash: s.dashed ? [5, 3] : [], pointRadius: s.style === 'dots' ? s.size / 2 : 0, spanGaps: false,
      });
    });
    const [first, last] = x_range(plot);
    for (const level of plot.levels)
      sets.push({
        label: level.label || '', unnamed: true, level: true, data: [first, last].map((x) => ({x, y: level.value})),
        showLine: true, borderColor: grey, borderWidth: 1, borderDash: [2, 3], pointRadius: 0, pointHitRadius: 0,
      });
    return sets;
  }

  /// As in the picture: x as far as there are points.
  const x_range = (plot) => plot.x_range || range(plot.series.flatMap((s) => s.x.filter((x) => x !== null)));

  function axis(label, log, limits) {
    const scale = {type: log ? 'logarithmic' : 'linear', title: {display: true, text: label},
                   ticks: {callback: text, includeBounds: false}};
    if (limits) [scale.min, scale.max] = limits;
    return scale;
  }

  /// Drag a rectangle to see it alone, double click to see everything again.
  function addZoom(chart, plot) {
    const canvas = chart.canvas;
    const inside = (event) => {
      const box = canvas.getBoundingClientRect(), area = chart.chartArea;
      return [Math.min(Math.max(event.clientX - box.left, area.left), area.right),
              Math.min(Math.max(event.clientY - box.top, area.top), area.bottom)];
    };
    let from = null;
    canvas.addEventListener('pointerdown', (event) => { from = inside(event); });
    canvas.addEventListener('pointermove', (event) => {
      if (!from) return;
      chart.selection = [from, inside(event)];
      chart.draw();
    });
    window.addEventListener('pointerup', (event) => {
      if (!from) return;
      const [a, b] = [from, inside(event)];
      from = chart.selection = null;
      if (Math.abs(a[0] - b[0]) < 6 && Math.abs(a[1] - b[1]) < 6) return chart.draw();
      for (const [name, i] of [['x', 0], ['y', 1]]) {
        const ends = [a[i], b[i]].map((pixel) => chart.scales[name].getValueForPixel(pixel));
        [chart.options.scales[name].min, chart.options.scales[name].max] = [Math.min(...ends), Math.max(...ends)];
      }
      chart.update();
    });
    canvas.addEventListener('dblclick', () => {
      chart.options.scales.x = axis(plot.x_label, plot.x_log, x_range(plot));
      chart.options.scales.y = axis(plot.y_label, plot.y_log, plot.y_range);
      chart.update();
    });
  }

  const selection = {
    id: 'selection',
    afterDraw(chart) {
      if (!chart.selection) return;
      const [[x1, y1], [x2, y2]] = chart.selection;
      chart.ctx.save();
      chart.ctx.fillStyle = 'rgba(0, 114, 178, 0.12)';
      chart.ctx.fillRect(x1, y1, x2 - x1, y2 - y1);
      chart.ctx.restore();
    },
  };

  function makeChart(canvas, plot) {
    const sets = datasets(plot);
    const chart = new Chart(canvas, {
      type: 'scatter',
      data: {datasets: sets},
      plugins: [selection],
      options: {
        animation: false, responsive: true, maintainAspectRatio: false,
        interaction: {mode: 'nearest', axis: 'xy', intersect: false},
        scales: {x: axis(plot.x_label, plot.x_log, x_range(plot)), y: axis(plot.y_label, plot.y_log, plot.y_range)},
        plugins: {
          title: {display: Boolean(plot.title), text: plot.title, align: 'start', padding: 2},
          legend: {
            display: sets.filter((s) => !s.band && !s.unnamed).length > 0,
            labels: {boxWidth: 16, boxHeight: 2, filter: (item, data) => {
              const set = data.datasets[item.datasetIndex];
              return !set.band && !set.unnamed;
            }},
            onClick(event, item, legend) {
              const {chart: owner} = legend, {series} = owner.data.datasets[item.datasetIndex];
              const show = !owner.isDatasetVisible(item.datasetIndex);
              owner.data.datasets.forEach((set, i) => { if (set.series === series) owner.setDatasetVisibility(i, show); });
              owner.update();
            },
          },
          tooltip: {
            filter: (item) => !item.dataset.band && !item.dataset.level,
            callbacks: {
              label: (item) => `${item.dataset.label}: ${text(item.parsed.y)} at ${text(item.parsed.x)}`,
            },
          },
        },
      },
    });
    addZoom(chart, plot);
    return chart;
  }

  function csv(plot) {
    const quoted = (s) => '"' + s.replaceAll('"', '""') + '"';
    const rows = [['series', plot.x_label || 'x', plot.y_label || 'y', 'low', 'high'].map(quoted).join(',')];
    for (const s of plot.series)
      s.x.forEach((x, i) => {
        rows.push([quoted(s.label || plot.title), x, s.y[i], s.low ? s.low[i] : '', s.low ? s.high[i] : ''].join(','));
      });
    return rows.join('\n') + '\n';
  }

  function save(name, type, content) {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([content], {type}));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  for (const box of document.querySelectorAll('.plot')) {
    const plot = JSON.parse(box.querySelector('script').textContent);
    const svg = box.querySelector('svg');
    const name = (plot.title || 'plot').replace(/[^A-Za-z0-9]+/g, '_');
    const tools = document.createElement('div');
    tools.className = 'tools';
    const button = (label, does) => {
      const b = document.createElement('button');
      b.type = 'button';
      b.textContent = label;
      b.addEventListener('click', does);
      tools.append(b);
    };
    button('CSV', () => save(name + '.csv', 'text/csv', csv(plot)));
    button('SVG', () => save(name + '.svg', 'image/svg+xml', svg.outerHTML));
    tools.append('drag: zoom · double click: all · click on a name: hide');
    box.append(tools);

    const wake = () => {
      if (box.chart) return;
      const {width, height} = svg.getBoundingClientRect();
      const frame = document.createElement('div');
      frame.className = 'live';
      frame.style.height = Math.max(height, 220) + 'px';
      const canvas = document.createElement('canvas');
      frame.append(canvas);
      box.insertBefore(frame, svg);
      box.classList.add('awake');
      if (width > 0) box.chart = makeChart(canvas, plot);
    };
    box.addEventListener('pointerenter', wake);
    box.addEventListener('focusin', wake);
    box.tabIndex = 0;
    box.plotCsv = () => csv(plot);
  }
})();
