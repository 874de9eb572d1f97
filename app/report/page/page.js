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

  function axis(label, log, limits, names) {
    const scale = {type: log ? 'logarithmic' : 'linear', title: {display: Boolean(label), text: label},
                   ticks: {callback: text, includeBounds: false}};
    if (limits) [scale.min, scale.max] = limits;
    // Names of columns in place of numbers, in the middle of each.
    if (names) {
      scale.ticks = {callback: (x) => (Number.isInteger(x - 0.5) ? names[x - 0.5] : ''), stepSize: 0.5, maxRotation: 0};
      scale.grid = {display: false};
    }
    return scale;
  }

  // A kind of plot tells for every chart of it (a view): what Chart.js is given, its axes, and which of them zoom; and
  // the rows of its CSV file.

  /// As in the picture: x as far as there are points.
  const x_range = (plot) => plot.x_range || range(plot.series.flatMap((s) => s.x.filter((x) => x !== null)));
  const group = (s, index) => (s.group === undefined ? index : s.group);

  /// The sets of points; a band is a pair of its own, hidden with its series.
  function datasets(plot) {
    const sets = [];
    plot.series.forEach((s, index) => {
      const at = (y) => s.x.map((x, i) => ({x, y: y[i]}));
      const colour = s.colour + (s.fade || '');
      const common = {series: index, group: group(s, index), borderColor: colour, backgroundColor: colour, pointHoverRadius: 4};
      if (s.low) {
        const edge = {...common, band: true, showLine: true, borderWidth: 0, pointRadius: 0, pointHitRadius: 0};
        sets.push({...edge, label: '', data: at(s.low)});
        sets.push({...edge, label: '', data: at(s.high), fill: '-1', backgroundColor: s.colour + '29'});
      }
      const stems = s.style === 'bars', dots = s.style === 'dots';
      const data = stems ? at(s.y).flatMap((p) => [{x: p.x, y: 0}, p, {x: p.x, y: NaN}]) : at(s.y);
      sets.push({
        ...common, data, label: s.label || plot.title, unnamed: s.unnamed || !s.label, showLine: !dots || s.joined,
        borderWidth: s.width || 1.6, borderDash: s.dashed ? [5, 3] : [], pointRadius: dots ? s.size / 2 : 0, spanGaps: false,
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

  const curves = {
    views(plot) {
      const sets = datasets(plot);
      return [{
        type: 'scatter', data: {datasets: sets}, title: plot.title, zoomed: ['x', 'y'],
        axes: () => ({x: axis(plot.x_label, plot.x_log, x_range(plot), plot.names), y: axis(plot.y_label, plot.y_log, plot.y_range)}),
        interaction: {mode: 'nearest', axis: 'xy', intersect: false},
        legend: {
          display: sets.some((s) => !s.band && !s.unnamed),
          labels: {boxWidth: 16, boxHeight: 2, filter: (item, data) => {
            const set = data.datasets[item.datasetIndex];
            return !set.band && !set.unnamed;
          }},
          onClick(event, item, legend) {
            const {chart} = legend, {group: clicked} = chart.data.datasets[item.datasetIndex];
            const show = !chart.isDatasetVisible(item.datasetIndex);
            chart.data.datasets.forEach((set, i) => { if (set.group === clicked) chart.setDatasetVisibility(i, show); });
            chart.update();
          },
        },
        told: (item) => `${item.dataset.label}: ${text(item.parsed.y)}` + (plot.names ? '' : ` at ${text(item.parsed.x)}`),
      }];
    },
    csv(plot) {
      const rows = [['series', plot.x_label || 'x', plot.y_label || 'y', 'low', 'high']];
      for (const s of plot.series)
        s.x.forEach((x, i) => rows.push([s.label || plot.title, x, s.y[i], s.low ? s.low[i] : '', s.low ? s.high[i] : '']));
      return rows;
    },
  };

  const whiskers = {
    id: 'whiskers',
    afterDatasetsDraw(chart) {
      const {ctx, scales: {x}, chartArea: area} = chart;
      ctx.save();
      ctx.beginPath();
      ctx.rect(area.left, area.top, area.width, area.height);
      ctx.clip();
      ctx.beginPath();
      chart.data.bars.forEach((bar, i) => {
        if (!(bar.error > 0)) return;
        const [low, high] = [bar.value - bar.error, bar.value + bar.error].map((v) => x.getPixelForValue(v));
        const {y} = chart.getDatasetMeta(0).data[i];
        for (const end of [low, high]) { ctx.moveTo(end, y - 4); ctx.lineTo(end, y + 4); }
        ctx.moveTo(low, y);
        ctx.lineTo(high, y);
      });
      ctx.strokeStyle = '#222';
      ctx.stroke();
      ctx.restore();
    },
  };

  const bars = {
    views: (plot) => [{
      type: 'bar', title: plot.title, zoomed: ['x'], plugins: [whiskers], indexAxis: 'y', legend: {display: false},
      data: {bars: plot.bars, labels: plot.bars.map((b) => b.label), datasets: [{
        label: plot.title, data: plot.bars.map((b) => b.value), backgroundColor: plot.bars.map((b) => b.colour),
        categoryPercentage: 0.9, barPercentage: 0.8,
      }]},
      axes: () => ({x: axis(plot.x_label, false, plot.x_range), y: {type: 'category', ticks: {autoSkip: false}, grid: {display: false}}}),
      interaction: {mode: 'nearest', axis: 'y', intersect: false},
      told: ({dataIndex}) => {
        const bar = plot.bars[dataIndex];
        return `${bar.label}: ${text(bar.value)}` + (bar.error > 0 ? ` ± ${text(bar.error)}` : '');
      },
    }],
    csv: (plot) => [['bar', plot.x_label || 'value', 'error'], ...plot.bars.map((b) => [b.label, b.value, b.error])],
  };

  /// The cells of a panel with their ends.
  const cells = (panel) => panel.cells.map(([left, right, low, high, value]) => (
    {x: [panel.x_edges[left], panel.x_edges[right]], y: [panel.y_edges[low], panel.y_edges[high]], value}));

  function colourOf(plot, value) {
    if (value === null) return plot.no_value;
    const [low, high] = plot.scale, steps = plot.colours.length;
    return plot.colours[Math.min(steps - 1, Math.max(0, Math.floor((value - low) / (high - low) * steps)))];
  }

  const rectangles = {
    id: 'rectangles',
    beforeDatasetsDraw(chart) {
      const {ctx, scales: {x, y}, chartArea: area} = chart, {plot} = chart.data;
      ctx.save();
      ctx.beginPath();
      ctx.rect(area.left, area.top, area.width, area.height);
      ctx.clip();
      for (const cell of chart.data.cells) {
        const [left, right] = cell.x.map((v) => Math.round(x.getPixelForValue(v)));
        const [bottom, top] = cell.y.map((v) => Math.round(y.getPixelForValue(v)));
        ctx.fillStyle = colourOf(plot, cell.value);
        ctx.fillRect(left, top, right - left, bottom - top);
      }
      ctx.restore();
    },
  };

  /// The cell under the pointer.
  if (Chart.Interaction)
    Chart.Interaction.modes.cell = (chart, event) => {
      const {x, y} = chart.scales, at = [x.getValueForPixel(event.x), y.getValueForPixel(event.y)];
      const index = chart.data.cells.findIndex((c) => at[0] >= c.x[0] && at[0] < c.x[1] && at[1] >= c.y[0] && at[1] < c.y[1]);
      return index < 0 ? [] : [{element: chart.getDatasetMeta(0).data[index], datasetIndex: 0, index}];
    };

  const map = {
    views: (plot) => plot.panels.map((panel, number) => {
      const list = cells(panel), middle = ([a, b]) => (a + b) / 2;
      return {
        type: 'scatter', title: panel.title || plot.title, zoomed: ['x', 'y'], plugins: [rectangles], legend: {display: false},
        data: {plot, cells: list, datasets: [
          {label: plot.value_label, data: list.map((c) => ({x: middle(c.x), y: middle(c.y)})), pointRadius: 0, pointHoverRadius: 3,
           pointHoverBackgroundColor: '#fff', pointHoverBorderColor: '#000'},
          {data: panel.line.map(([x, y]) => ({x, y})), showLine: true, borderColor: '#111', borderWidth: 1.2, pointRadius: 0, pointHitRadius: 0, level: true},
        ]},
        axes: () => ({x: axis(plot.x_label, false, panel.x_range), y: axis(number === 0 ? plot.y_label : '', false, plot.y_range)}),
        interaction: {mode: 'cell', intersect: false},
        told: ({dataIndex}) => {
          const {x, y, value} = list[dataIndex];
          return `${plot.value_label}: ${value === null ? plot.grey || 'none' : text(value)} at ${text(middle(x))}; ${text(middle(y))}`;
        },
      };
    }),
    below(plot) {
      const legend = document.createElement('div'), bar = document.createElement('i');
      legend.className = 'scale';
      bar.style.background = `linear-gradient(to right, ${plot.colours.join(',')})`;
      const [low, high] = plot.scale;
      legend.append(`${plot.value_label}: ${text(low)} `, bar, ` ${text(high)}`);
      if (plot.grey) {
        const grey_bar = document.createElement('i');
        grey_bar.style.cssText = `background: ${plot.no_value}; width: 14px; margin-left: 14px`;
        legend.append(grey_bar, ` ${plot.grey}`);
      }
      return legend;
    },
    csv: (plot) => [
      ['panel', 'x from', 'x to', 'y from', 'y to', plot.value_label],
      ...plot.panels.flatMap((panel) => cells(panel).map((c) => [panel.title, ...c.x, ...c.y, c.value === null ? '' : c.value])),
    ],
  };

  const kinds = {curves, bars, map};

  /// Drag a rectangle to see it alone, double click to see everything again.
  function addZoom(chart, view) {
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
        if (!view.zoomed.includes(name)) continue;
        const ends = [a[i], b[i]].map((pixel) => chart.scales[name].getValueForPixel(pixel));
        [chart.options.scales[name].min, chart.options.scales[name].max] = [Math.min(...ends), Math.max(...ends)];
      }
      chart.update();
    });
    canvas.addEventListener('dblclick', () => {
      Object.assign(chart.options.scales, view.axes());
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

  function makeChart(canvas, view) {
    const chart = new Chart(canvas, {
      type: view.type,
      data: view.data,
      plugins: [selection, ...(view.plugins || [])],
      options: {
        animation: false, responsive: true, maintainAspectRatio: false, indexAxis: view.indexAxis || 'x',
        interaction: view.interaction,
        scales: view.axes(),
        plugins: {
          title: {display: Boolean(view.title), text: view.title, align: 'start', padding: 2},
          legend: view.legend,
          tooltip: {
            filter: (item) => !item.dataset.band && !item.dataset.level,
            callbacks: {title: () => '', label: view.told},
          },
        },
      },
    });
    addZoom(chart, view);
    return chart;
  }

  function csv(plot) {
    const cell = (c) => (typeof c === 'string' && c !== '' ? '"' + c.replaceAll('"', '""') + '"' : c);
    return kinds[plot.kind].csv(plot).map((row) => row.map(cell).join(',')).join('\n') + '\n';
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
    const kind = kinds[plot.kind];
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
    tools.append('drag: zoom · double click: all' + (plot.kind === 'curves' ? ' · click on a name: hide' : ''));
    box.append(tools);

    const wake = () => {
      if (box.charts) return;
      const {width, height} = svg.getBoundingClientRect();
      const live = document.createElement('div');
      live.className = 'live';
      const views = kind.views(plot);
      const canvases = views.map(() => {
        const frame = document.createElement('div'), canvas = document.createElement('canvas');
        frame.className = 'chart';
        frame.style.height = Math.max(height, 220) + 'px';
        frame.append(canvas);
        live.append(frame);
        return canvas;
      });
      box.insertBefore(live, svg);
      if (kind.below) box.insertBefore(kind.below(plot), svg);
      box.classList.add('awake');
      box.charts = width > 0 ? views.map((view, i) => makeChart(canvases[i], view)) : [];
    };
    box.addEventListener('pointerenter', wake);
    box.addEventListener('focusin', wake);
    box.tabIndex = 0;
    box.plotCsv = () => csv(plot);
  }
})();
