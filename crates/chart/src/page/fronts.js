  // The charts of fronts: drawn again from the points, to be zoomed and filtered.
  const fronts = () => {
    const data = JSON.parse(document.getElementById('points').textContent);
    const sections = new Map([...document.querySelectorAll('section[data-scene]')].map((s) => [s.dataset.scene, s]));
    const families = [...new Set(data.points.map((point) => point.family))];
    const marks = {
      'constant colour': ['#8a8a8a', 'M-4,0 0,-4 4,0 0,4Z'],
      flat: ['#d55e00', 'M-4,-4 4,-4 4,4 -4,4Z'],
      Gouraud: ['#0072b2', 'M0,-5 5,4 -5,4Z'],
      Phong: ['#009e73', 'M-4.5,0a4.5,4.5 0 1,0 9,0a4.5,4.5 0 1,0 -9,0Z'],
      automatic: ['#e69f00', 'M0,-6 2,-2 6,0 2,2 0,6 -2,2 -6,0 -2,-2Z'],
    };
    const mark = (family) => marks[family] ?? ['#cc79a7', 'M-5,-4 5,-4 0,5Z'];
    const steps = ' (steps of 1/255)';
    const measures = [
      ['RMS error of covered pixels' + steps, (p) => p.rms],
      ['RMS error of the whole picture' + steps, (p) => p.whole.rms],
      ['largest error of covered pixels' + steps, (p) => p.max],
      ['largest error of the whole picture' + steps, (p) => p.whole.max],
      ['95 % of covered pixels keep to' + steps, (p) => p.p95],
      ['95 % of the whole picture keep to' + steps, (p) => p.whole.p95],
      ['mean ꟻLIP of covered pixels', (p) => p.flip],
      ['mean ꟻLIP of the whole picture', (p) => p.whole.flip],
      ['RMS error of covered pixels, float target (white = 1)', (p) => p.float.rms],
      ['RMS error of the whole picture, float target (white = 1)', (p) => p.whole.float.rms],
    ];
    const times = [
      ['time of a frame (reference frame = 1)', (p) => p.ratio, (p) => p.ratio_quartiles],
      ['time of a frame (ms)', (p) => p.ms, (p) => p.ms_quartiles],
    ];
    // What is chosen: the scene and adapter, the places of both measures, words to be found, families that are left out; and
    // the ends of both axes, as logarithms, where they are not those of all points.
    const first = { scene: [...sections.keys()][0], backend: data.points[0]?.backend, y: 0, x: 0 };
    const state = { ...first, words: '', off: new Set(), view: null, zoomed: false };

    // The charts that scripts leave alone are of the same kind.
    const space = document.querySelector('svg').namespaceURI;
    const svg = (tag, attributes, ...children) => {
      const made = document.createElementNS(space, tag);
      for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
      made.append(...children);
      return made;
    };
    const choice = (name, options, set) => {
      const option = ([text, value]) => Object.assign(element('option', text), { value });
      const select = element('select', '', ...options.map(option));
      select.name = name.toLowerCase();
      select.addEventListener('change', () => { set(select.value); state.view = null; draw(); });
      return element('label', name + ' ', select);
    };

    // Errors of 0 have no logarithm; they stand at the bottom, at a tenth of the least that has one.
    const shown = () => {
      const [, error] = measures[state.y];
      const words = state.words.toLowerCase();
      const here = data.points.map((point, i) => ({ point, i }))
        .filter(({ point }) => point.scene === state.scene && point.backend === state.backend);
      const least = Math.min(...here.map(({ point }) => error(point)).filter((value) => value > 0));
      const floor = Number.isFinite(least) ? least / 2 : 1e-3;
      const wanted = here.filter(({ point }) => !state.off.has(point.family) && point.words.toLowerCase().includes(words));
      return wanted.map((entry) => ({ ...entry, x: times[state.x][1](entry.point), y: Math.max(error(entry.point), floor) }));
    };
    const front = (points) => {
      const sorted = [...points].sort((a, b) => a.x - b.x || a.y - b.y);
      let least = Infinity;
      return sorted.filter(({ y }) => y < least && ((least = y), true));
    };
    const ticks = (low, high) => {
      const made = [];
      const few = high - low > 1.2 ? [1, 2, 5] : [1, 1.2, 1.5, 2, 3, 4, 5, 6, 7, 8];
      for (let power = Math.floor(low); power <= high; power += 1) {
        for (const digit of high - low > 3 ? [1] : few) {
          const at = Math.log10(digit) + power;
          if (at >= low && at <= high) made.push([at, String(Number((digit * 10 ** power).toPrecision(2)))]);
        }
      }
      return made;
    };

    const number = (value) => (value === 0 ? '0' : Number(value.toPrecision(3)).toString());
    const content = ({ point, i }) => {
      const picture = (caption, source) => {
        const image = Object.assign(element('img'), { src: source, alt: '' });
        return element('div', '', image, caption);
      };
      const [own, difference] = data.pictures[i];
      const scene = data.scenes.find(({ name }) => name === point.scene);
      const three = [['as drawn', own], ['the truth', scene.picture], ['difference', difference]];
      const pictures = element('div', '', ...three.map(([caption, source]) => picture(caption, source)));
      pictures.className = 'pictures';
      const quartiles = ([low, high], digits) => `${low.toFixed(digits)} … ${high.toFixed(digits)}`;
      const rows = [
        ['frame', `${point.ms.toFixed(2)} ms (${quartiles(point.ms_quartiles, 2)})`],
        ['of the reference', `${point.ratio.toFixed(2)} (${quartiles(point.ratio_quartiles, 2)})`],
        ...[['covered', point], ['whole picture', point.whole]].flatMap(([area, e]) => [
          [`${area}, steps`, `RMS ${number(e.rms)}, 95 % ${number(e.p95)}, max ${number(e.max)}`],
          [`${area}, float`, `RMS ${number(e.float.rms)}, max ${number(e.float.max)}`],
          [`${area}, ꟻLIP`, number(e.flip)],
        ]),
      ];
      const row = ([name, text]) => element('div', '', element('dt', name), element('dd', text));
      const list = element('dl', '', ...rows.map(row));
      const title = `${point.words}, ${point.detail}, ${point.triangles} triangles`;
      return [element('h3', title), pictures, list, element('code', point.command)];
    };

    const chart = (points) => {
      const width = Math.max(280, Math.min(1100, sections.get(state.scene).clientWidth));
      const height = Math.max(300, Math.min(520, width * 0.6));
      const box = { left: 52, right: width - 12, top: 10, bottom: height - 44 };
      const range = (values) => {
        const [low, high] = [Math.min(...values), Math.max(...values)].map(Math.log10);
        const room = Math.max((high - low) * 0.06, 0.02);
        return [low - room, high + room];
      };
      const all = points.length ? points : [{ x: 1, y: 1 }];
      state.view ??= [range(all.map(({ x }) => x)), range(all.map(({ y }) => y))];
      const [[x0, x1], [y0, y1]] = state.view;
      const px = (x) => box.left + ((Math.log10(x) - x0) / (x1 - x0)) * (box.right - box.left);
      const py = (y) => box.bottom - ((Math.log10(y) - y0) / (y1 - y0)) * (box.bottom - box.top);
      const told = { class: 'front', role: 'img', 'aria-label': 'error against time' };
      const root = svg('svg', { viewBox: `0 0 ${width} ${height}`, width, height, ...told });
      const plot = { x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top };
      root.append(svg('clipPath', { id: 'inside' }, svg('rect', plot)));
      const text = (label, x, y, extra) => {
        const made = svg('text', { x, y, ...extra });
        made.textContent = label;
        return made;
      };
      for (const [at, label] of ticks(x0, x1)) {
        const x = px(10 ** at);
        root.append(svg('line', { class: 'grid', x1: x, x2: x, y1: box.top, y2: box.bottom }));
        root.append(text(label, x, box.bottom + 15, { 'text-anchor': 'middle' }));
      }
      for (const [at, label] of ticks(y0, y1)) {
        const y = py(10 ** at);
        root.append(svg('line', { class: 'grid', x1: box.left, x2: box.right, y1: y, y2: y }));
        root.append(text(label, box.left - 6, y + 4, { 'text-anchor': 'end' }));
      }
      const upright = `translate(13 ${(box.top + box.bottom) / 2}) rotate(-90)`;
      root.append(
        text(times[state.x][0], (box.left + box.right) / 2, height - 8, { 'text-anchor': 'middle' }),
        text(measures[state.y][0], 0, 0, { 'text-anchor': 'middle', transform: upright }),
      );
      const inside = svg('g', { 'clip-path': 'url(#inside)' });
      root.append(inside);
      const best = front(points);
      const corners = best.flatMap(({ x, y }, i) => (i ? [[x, best[i - 1].y], [x, y]] : [[x, y]]));
      inside.append(svg('polyline', { class: 'line', points: corners.map(([x, y]) => `${px(x)},${py(y)}`).join(' ') }));
      const ordered = [...points.filter((point) => !best.includes(point)), ...best];
      for (const entry of ordered) {
        const [color, path] = mark(entry.point.family);
        const [low, high] = times[state.x][2](entry.point);
        const y = py(entry.y);
        const standing = best.includes(entry) ? 'best' : 'beaten';
        const group = svg('g', { class: standing, 'data-method': entry.point.method, tabindex: 0 },
          svg('line', { x1: px(low), x2: px(high), y1: y, y2: y, stroke: color }),
          svg('path', { d: path, transform: `translate(${px(entry.x)} ${y})`, fill: color }),
          svg('circle', { class: 'hit', cx: px(entry.x), cy: y, r: 9 }));
        pointable(group, () => content(entry));
        inside.append(group);
      }
      state.box = box;
      return root;
    };

    // The wheel zooms about the pointer, dragging moves, two fingers do both, and so do the buttons above.
    const plots = element('div');
    plots.className = 'plot';
    const look = (view) => {
      Object.assign(state, { view, zoomed: true });
      draw();
    };
    const zoom = (factor, fx = 0.5, fy = 0.5) => look(state.view.map(([low, high], axis) => {
      const at = low + (axis ? 1 - fy : fx) * (high - low);
      return [at - (at - low) * factor, at + (high - at) * factor];
    }));
    // Where a place of the window is within the chart's axes, from 0 to 1 to the right and down.
    const share = ([x, y]) => {
      const { left, top } = plots.firstChild.getBoundingClientRect();
      const { box } = state;
      return [(x - left - box.left) / (box.right - box.left), (y - top - box.top) / (box.bottom - box.top)];
    };
    plots.addEventListener('wheel', (event) => {
      event.preventDefault();
      zoom(event.deltaY > 0 ? 1.25 : 0.8, ...share([event.clientX, event.clientY]));
    }, { passive: false });

    // Pointers that are down, by their numbers; and, since the last of them came or went, their places and the view then.
    const held = new Map();
    const start = { places: [], view: null, moves: false };
    const begin = () => Object.assign(start, { places: [...held.values()], view: state.view, moves: false });
    const middle = (places) => [0, 1].map((k) => places.reduce((sum, place) => sum + place[k], 0) / places.length);
    const apart = ([a, b]) => (b ? Math.max(Math.hypot(a[0] - b[0], a[1] - b[1]), 10) : 1);
    const follow = () => {
      const places = [...held.values()];
      const factor = apart(start.places) / apart(places);
      const [was, is] = [start.places, places].map((all) => share(middle(all)));
      look(start.view.map(([low, high], axis) => {
        const [before, now] = axis ? [1 - was[1], 1 - is[1]] : [was[0], is[0]];
        const [at, size] = [low + before * (high - low), (high - low) * factor];
        return [at - now * size, at + (1 - now) * size];
      }));
    };
    plots.addEventListener('pointerdown', (event) => {
      if (event.button !== 0 || (event.pointerType === 'mouse' && event.target.closest('g[data-method]'))) return;
      // More fingers than two say nothing more.
      if (held.size === 2) return;
      held.set(event.pointerId, [event.clientX, event.clientY]);
      begin();
    });
    addEventListener('pointermove', (event) => {
      if (!held.has(event.pointerId)) return;
      const [x, y] = held.get(event.pointerId);
      // A tap may tremble.
      if (held.size === 1 && !start.moves && Math.hypot(event.clientX - x, event.clientY - y) < 4) return;
      start.moves = true;
      held.set(event.pointerId, [event.clientX, event.clientY]);
      // What was touched is drawn anew; events that a script has made up belong to no pointer that could be kept.
      try { plots.setPointerCapture(event.pointerId); } catch { /* as before */ }
      follow();
    });
    for (const end of ['pointerup', 'pointercancel']) {
      addEventListener(end, (event) => { if (held.delete(event.pointerId)) begin(); });
    }

    const table = (points) => {
      const best = front(points);
      const figures = ['triangles', 'ms', '× reference', 'RMS', '95 %', 'max', 'ꟻLIP', 'whole RMS', 'whole max'];
      const head = ['method', 'detail', ...figures, 'front'];
      const rows = points.map((entry) => {
        const { point: p } = entry;
        const errors = [p.rms, p.p95, p.max, p.flip, p.whole.rms, p.whole.max].map(number);
        const timed = [p.triangles, p.ms.toFixed(3), p.ratio.toFixed(2)];
        const cells = [p.words, p.detail, ...timed, ...errors, best.includes(entry) ? 'yes' : 'no'];
        return element('tr', '', ...cells.map((text) => element('td', String(text))));
      });
      const names = element('tr', '', ...head.map((name) => element('th', name)));
      const made = element('table', '', element('thead', '', names), element('tbody', '', ...rows));
      for (const row of made.rows) for (const cell of [...row.cells].slice(0, 2)) cell.className = 'name';
      return made;
    };

    const points = element('details', '', element('summary', 'every point in a table'));
    const rows = element('div');
    rows.className = 'table points';
    points.append(rows);
    const draw = () => {
      pin(null);
      for (const [name, section] of sections) section.hidden = name !== state.scene;
      const section = sections.get(state.scene);
      const still = section.querySelector('figure');
      still.hidden = true;
      still.before(plots);
      section.append(points);
      const now = shown();
      if (!state.view) state.zoomed = false;
      plots.classList.toggle('zoomed', state.zoomed);
      plots.replaceChildren(chart(now));
      rows.replaceChildren(table(now));
    };

    const controls = document.getElementById('controls');
    const family = (name) => {
      const box = Object.assign(element('input'), { type: 'checkbox', checked: true, name: 'family', value: name });
      box.addEventListener('change', () => { state.off[box.checked ? 'delete' : 'add'](name); draw(); });
      const [color, path] = mark(name);
      const swatch = svg('svg', { viewBox: '-6 -6 12 12', width: 12, height: 12 }, svg('path', { d: path, fill: color }));
      return element('label', '', box, swatch, ' ' + name);
    };
    const words = Object.assign(element('input'), { type: 'search', name: 'words', placeholder: 'infinite, 4 samples …' });
    words.addEventListener('input', () => { state.words = words.value; draw(); });
    const button = (label, text, act) => {
      const made = Object.assign(element('button', label), { type: 'button', title: text });
      made.addEventListener('click', act);
      return made;
    };
    const backends = [...new Set(data.points.map(({ backend }) => backend))];
    const adapter = choice('Adapter', backends.map((name) => [name, name]), (name) => { state.backend = name; });
    controls.append(
      choice('Scene', [...sections.keys()].map((name) => [name, name]), (name) => { state.scene = name; }),
      ...(backends.length > 1 ? [adapter] : []),
      choice('Error', measures.map(([name], i) => [name, i]), (i) => { state.y = Number(i); }),
      choice('Time', times.map(([name], i) => [name, i]), (i) => { state.x = Number(i); }),
      element('label', 'Words ', words),
      element('span', '', ...families.map(family)),
      element('span', '', button('+', 'zoom in', () => zoom(0.7)), button('−', 'zoom out', () => zoom(1.4)),
        button('all', 'the whole chart', () => { state.view = null; draw(); })),
    );
    controls.hidden = false;
    // A chart as wide as the page stays so.
    let wide = innerWidth;
    addEventListener('resize', () => { if (innerWidth !== wide) { wide = innerWidth; draw(); } });
    const asked = decodeURIComponent(location.hash.slice(1));
    if (sections.has(asked)) {
      state.scene = asked;
      controls.querySelector('select[name=scene]').value = asked;
    }
    draw();
  };
  if (document.getElementById('points')) fronts();
