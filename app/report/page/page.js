// What makes the plots of a report interactive. The drawing is Chart.js; a plot stays the picture it is until someone
// points at it, and on paper.
(() => {
  'use strict';
  if (typeof Chart === 'undefined') return;

  const text = (x) =>
    x !== 0 && (Math.abs(x) >= 1e6 || Math.abs(x) < 1e-3) ? x.toExponential(4) : String(Number(x.toPrecision(6)));

  /// With the digits that tell neighbouring ticks apart.
  function tickText(x, index, ticks) {
    const step = ticks.length > 1 ? Math.abs(ticks[1].value - ticks[0].value) : 0;
    const largest = Math.max(...ticks.map((t) => Math.abs(t.value)));
    if (!(step > 0) || this.type === 'logarithmic') return text(x);
    if (x === 0) return '0';
    if (largest >= 1e6 || step < 1e-5) return x.toExponential(Math.min(15, Math.max(0, Math.ceil(Math.log10(largest / step) - 1e-6))));
    return x.toFixed(Math.min(12, Math.max(0, Math.ceil(-Math.log10(step) - 1e-6))));
  }

  /// A title in lines that fit.
  function titleLines(title, width) {
    const letters = document.createElement('canvas').getContext('2d');
    letters.font = `bold 12px ${Chart.defaults.font.family}`;
    const lines = [];
    for (const word of title.split(' ')) {
      const longer = lines.length ? `${lines[lines.length - 1]} ${word}` : word;
      if (lines.length && letters.measureText(longer).width <= width - 8) lines[lines.length - 1] = longer;
      else lines.push(word);
    }
    return lines;
  }

  function axis({label, log, range, names}) {
    const scale = {type: log ? 'logarithmic' : 'linear', title: {display: Boolean(label), text: label}, offset: false,
                   min: Math.min(...range), max: Math.max(...range), reverse: range[0] > range[1],
                   grid: {display: !names, offset: false}, ticks: {callback: tickText, includeBounds: false}};
    // In place of numbers, in the middle of each column or row.
    if (names)
      scale.ticks = {callback: (x) => (Number.isInteger(x - 0.5) ? names[x - 0.5] : ''), stepSize: 0.5, maxRotation: 0, autoSkip: false};
    return scale;
  }

  /// The sets of points of a panel: those of its marks, each behind its band, and the middles of its cells.
  function datasets(plot, panel) {
    const sets = panel.sets.flatMap((s) => {
      const at = (y) => s.x.map((x, i) => ({x, y: y[i]}));
      const all = {showLine: true, pointRadius: 0, pointHoverRadius: s.label ? 4 : 0, ...s};
      const band = s.low && {...all, label: '', data: [...at(s.high), ...at(s.low).reverse()], fill: 'shape',
                             borderWidth: 0, backgroundColor: s.borderColor + '29', band: true};
      return [...(band ? [band] : []), {...all, data: at(s.y)}];
    });
    const middle = (a, b) => (a + b) / 2;
    if (plot.scale)
      sets.push({label: plot.scale.label, cells: panel.cells, data: panel.cells.map(([x1, x2, y1, y2]) => ({x: middle(x1, x2), y: middle(y1, y2)})),
                 pointRadius: 0, pointHoverRadius: 3, pointHoverBackgroundColor: '#fff', pointHoverBorderColor: '#000'});
    return sets.reverse();  // Chart.js draws the first of them last
  }

  function described(plot, panel, {dataset: set, dataIndex, parsed: {x, y}}) {
    const error = set.error ? ` ± ${text(set.error)}` : '';
    if (panel.y.names) return `${set.label}: ${text(x)}${error}`;
    if (panel.x.names) return `${set.label}: ${text(y)}${error}`;
    if (!set.cells) return `${set.label}: ${text(y)} at ${text(x)}`;
    const value = set.cells[dataIndex][4];
    return `${set.label}: ${value === null ? plot.scale.grey || 'none' : text(value)} at ${text(x)}; ${text(y)}`;
  }

  /// The point to describe: of a map its cell, of rows the nearest one, else the nearest point that has a label.
  Chart.Interaction.modes.pointed = (chart, event) => {
    const {x, y} = chart.scales, at = [x.getValueForPixel(event.x), y.getValueForPixel(event.y)];
    const rows = chart.data.panel.y.names;
    const inside = ([x1, x2, y1, y2]) => at[0] >= x1 && at[0] < x2 && at[1] >= y1 && at[1] < y2;
    let nearest = [], least = Infinity;
    chart.data.datasets.forEach((set, datasetIndex) => {
      if (!set.label || !chart.isDatasetVisible(datasetIndex)) return;
      chart.getDatasetMeta(datasetIndex).data.forEach((element, index) => {
        if (element.skip || (set.cells && !inside(set.cells[index]))) return;
        const distance = Math.hypot(rows ? 0 : element.x - event.x, element.y - event.y);
        if (distance < least) [nearest, least] = [[{element, datasetIndex, index}], distance];
      });
    });
    return nearest;
  };

  /// The rows of its CSV file.
  function csv(plot) {
    const [{x, y}] = plot.panels, scale = plot.scale;
    const rows = scale
      ? [['panel', 'x from', 'x to', 'y from', 'y to', scale.label], ...plot.panels.flatMap((p) => p.cells.map((c) => [p.title, ...c]))]
      : [['series', ...(x.names ? [] : [x.label || 'x']), ...(y.names ? [] : [y.label || 'y']), 'low', 'high', 'error'],
         ...plot.panels[0].sets.filter((s) => s.label).flatMap((s) => s.x.map((value, i) =>
           [s.label, ...(x.names ? [] : [value]), ...(y.names ? [] : [s.y[i]]), s.low ? s.low[i] : '', s.low ? s.high[i] : '', s.error]))];
    const cell = (c) => (typeof c === 'string' && c !== '' ? '"' + c.replaceAll('"', '""') + '"' : c);
    return rows.map((row) => row.map(cell).join(',')).join('\n') + '\n';
  }

  const rectangles = {
    id: 'rectangles',
    beforeDatasetsDraw(chart) {
      const {ctx, scales: {x, y}, chartArea: area, data: {datasets, plot: {scale}}} = chart;
      if (!scale) return;
      const [low, high] = scale.range, steps = scale.colours.length;
      ctx.save();
      ctx.beginPath();
      ctx.rect(area.left, area.top, area.width, area.height);
      ctx.clip();
      for (const [x1, x2, y1, y2, value] of datasets[0].cells) {
        const [left, right] = [x1, x2].map((v) => Math.round(x.getPixelForValue(v)));
        const [bottom, top] = [y1, y2].map((v) => Math.round(y.getPixelForValue(v)));
        const step = Math.min(steps - 1, Math.max(0, Math.floor((value - low) / (high - low) * steps)));
        ctx.fillStyle = value === null ? scale.no_value : scale.colours[step];
        ctx.fillRect(left, top, right - left, bottom - top);
      }
      ctx.restore();
    },
  };

  /// Drag a rectangle to see it alone, double click to see everything again.
  const zoom = {
    id: 'zoom',
    afterInit(chart) {
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
        ['x', 'y'].forEach((name, i) => {
          const ends = [a[i], b[i]].map((pixel) => chart.scales[name].getValueForPixel(pixel));
          Object.assign(chart.options.scales[name], {min: Math.min(...ends), max: Math.max(...ends)});
        });
        chart.update();
      });
      canvas.addEventListener('dblclick', () => {
        Object.assign(chart.options.scales, chart.data.axes());
        chart.update();
      });
    },
    afterDraw(chart) {
      if (!chart.selection) return;
      const [[x1, y1], [x2, y2]] = chart.selection;
      chart.ctx.fillStyle = 'rgba(0, 114, 178, 0.12)';
      chart.ctx.fillRect(x1, y1, x2 - x1, y2 - y1);
    },
  };

  /// As in the picture: of lines with a name to choose from, the chosen one.
  function showLines(chart) {
    const {line, names} = annulus.chosenLine(), {datasets} = chart.data;
    const nameOf = (set) => set.label || (datasets.find((s) => s.group === set.group && s.label) || {}).label;
    datasets.forEach((set, i) => {
      const name = nameOf(set);
      if (names.includes(name)) chart.setDatasetVisibility(i, !line || name === line);
    });
    chart.update();
  }

  function makeChart(canvas, plot, panel) {
    const axes = () => ({x: axis(panel.x), y: axis(panel.y)}), sets = datasets(plot, panel), title = panel.title || plot.title;
    return new Chart(canvas, {
      type: 'scatter', data: {datasets: sets, plot, panel, axes}, plugins: [zoom, rectangles],
      options: {
        animation: false, responsive: true, maintainAspectRatio: false, scales: axes(), interaction: {mode: 'pointed'},
        onResize: (chart, {width}) => { chart.options.plugins.title.text = titleLines(title, width); },
        plugins: {
          title: {display: Boolean(title), text: titleLines(title, canvas.parentElement?.clientWidth || plot.width || 430), align: 'start', padding: 2},
          legend: {
            display: sets.some((s) => s.named), reverse: true,
            labels: {boxWidth: 16, boxHeight: 2, filter: (item, data) => data.datasets[item.datasetIndex].named && !data.datasets[item.datasetIndex].band},
            onClick(event, item, {chart}) {
              const {group} = sets[item.datasetIndex], show = !chart.isDatasetVisible(item.datasetIndex);
              sets.forEach((set, i) => { if (set.group === group) chart.setDatasetVisibility(i, show); });
              chart.update();
            },
          },
          tooltip: {callbacks: {title: () => '', label: (item) => described(plot, panel, item)}},
        },
      },
    });
  }

  const element = (name, className, ...content) => {
    const made = document.createElement(name);
    made.className = className;
    made.append(...content);
    return made;
  };

  /// The colours of a map and what they mean.
  function scaleBar({label, range, colours, grey, no_value}) {
    const bar = element('i', '');
    bar.style.background = `linear-gradient(to right, ${colours.join(',')})`;
    const legend = element('div', 'scale', `${label}: ${text(range[0])} `, bar, ` ${text(range[1])}`);
    if (grey) {
      const sample = element('i', '');
      sample.style.cssText = `background: ${no_value}; width: 14px; margin-left: 14px`;
      legend.append(sample, ` ${grey}`);
    }
    return legend;
  }

  function save(name, type, content) {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([content], {type}));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  window.addEventListener('annulus:lines', () => {
    for (const box of document.querySelectorAll('.plot')) (box.charts || []).forEach(showLines);
  });

  annulus.make('.plot', (box) => {
    const plot = annulus.numbers(box);
    const svg = box.querySelector('svg');
    const name = (plot.title || 'plot').replace(/[^A-Za-z0-9]+/g, '_');
    const button = (label, does) => {
      const made = element('button', '', label);
      made.type = 'button';
      made.addEventListener('click', does);
      return made;
    };
    const named = plot.panels.some((p) => p.sets.some((s) => s.named));
    box.append(element('div', 'tools', button('CSV', () => save(name + '.csv', 'text/csv', csv(plot))),
                       button('SVG', () => save(name + '.svg', 'image/svg+xml', svg.outerHTML)),
                       'drag: zoom · double click: all' + (named ? ' · click on a name: hide' : '')));

    const wake = () => {
      if (box.charts) return;
      const {width, height} = svg.getBoundingClientRect();
      const canvases = plot.panels.map(() => document.createElement('canvas'));
      const frames = canvases.map((canvas) => element('div', 'chart', canvas));
      for (const frame of frames) frame.style.height = Math.max(height, 220) + 'px';
      box.insertBefore(element('div', 'live', ...frames), svg);
      if (plot.scale) box.insertBefore(scaleBar(plot.scale), svg);
      box.classList.add('awake');
      box.charts = width > 0 ? canvases.map((canvas, i) => makeChart(canvas, plot, plot.panels[i])) : [];
      box.charts.forEach(showLines);
    };
    box.addEventListener('pointerenter', wake);
    box.addEventListener('focusin', wake);
    box.tabIndex = 0;
    box.plotCsv = () => csv(plot);
  });
})();
