'use strict';
(() => {
  // The card that tells what a point is: shown while it is pointed at, kept once it is clicked.
  const card = document.getElementById('card');
  const data = JSON.parse(document.getElementById('cards').textContent);
  let pinned = null;

  const element = (tag, text, ...children) => {
    const made = document.createElement(tag);
    if (text) made.textContent = text;
    made.append(...children);
    return made;
  };
  const content = ({ dataset }) => {
    if (!dataset.card) return [dataset.label];
    const { title, pictures, rows, command } = data.cards[dataset.card];
    const picture = ([caption, image]) =>
      element('div', '', Object.assign(element('img'), { src: data.images[image], alt: '' }), caption);
    const list = rows.map(([name, value]) => element('div', '', element('dt', name), element('dd', value)));
    const shown = element('div', '', ...pictures.map(picture));
    shown.className = 'pictures';
    return [element('h3', title), shown, element('dl', '', ...list), element('code', command)];
  };

  // Beside the point, on the side where there is room.
  const place = (hit) => {
    const { left, right, top } = hit.getBoundingClientRect();
    const { clientWidth: width, clientHeight: height } = document.documentElement;
    const { width: w, height: h } = card.getBoundingClientRect();
    const within = (at, size, end) => Math.max(8, Math.min(at, end - size - 8));
    card.style.left = within(right + 12 + w < width ? right + 12 : left - 12 - w, w, width) + 'px';
    card.style.top = within(top - h / 2, h, height) + 'px';
  };
  const show = (hit) => {
    card.replaceChildren(...content(hit));
    card.hidden = false;
    place(hit);
    // Pictures have no size before they are decoded.
    for (const image of card.querySelectorAll('img')) image.onload = () => place(hit);
  };
  const pin = (hit) => {
    pinned?.classList.remove('pinned');
    pinned = hit;
    pinned?.classList.add('pinned');
    card.classList.toggle('pinned', pinned !== null);
    card.hidden = pinned === null;
  };
  for (const hit of document.querySelectorAll('.hit')) {
    hit.addEventListener('mouseenter', () => pinned || show(hit));
    hit.addEventListener('mouseleave', () => pinned || (card.hidden = true));
    const keep = (event) => {
      event.stopPropagation();
      pin(hit);
      show(hit);
    };
    hit.addEventListener('click', keep);
    hit.addEventListener('keydown', (event) => event.key === 'Enter' && keep(event));
  }
  document.addEventListener('click', (event) => card.contains(event.target) || pin(null));
  document.addEventListener('keydown', (event) => event.key === 'Escape' && pin(null));

  // A click on an entry of the legend hides its series or shows it again.
  for (const entry of document.querySelectorAll('.legend button')) {
    entry.addEventListener('click', () => {
      const off = entry.getAttribute('aria-pressed') === 'true';
      entry.setAttribute('aria-pressed', String(!off));
      for (const part of entry.closest('figure').querySelectorAll('[data-series]')) {
        if (part.dataset.series === entry.value) part.style.display = off ? 'none' : '';
      }
    });
  }

  // The buttons choose among the charts of a section. An address that ends in # and a chart's name shows that chart.
  const buttons = [...document.querySelectorAll('fieldset.shown input[type=radio]')];
  const choose = () => {
    for (const button of buttons) document.getElementById(button.value).hidden = !button.checked;
    pin(null);
  };
  for (const button of buttons) {
    if (button.value === location.hash.slice(1)) button.checked = true;
    button.addEventListener('change', choose);
  }
  choose();

  // A click on a column's name sorts by it, another one the other way round. Numbers go by value, before words.
  const value = (cell) => {
    const number = Number.parseFloat(cell.textContent.replace('−', '-'));
    return Number.isNaN(number) ? cell.textContent : number;
  };
  const before = (a, b) => {
    if (typeof a === typeof b) return a < b ? -1 : Number(a > b);
    return typeof a === 'number' ? -1 : 1;
  };
  document.addEventListener('click', ({ target }) => {
    const head = target.closest('thead th');
    if (!head) return;
    const up = head.getAttribute('aria-sort') !== 'ascending';
    for (const other of head.parentNode.children) other.removeAttribute('aria-sort');
    head.setAttribute('aria-sort', up ? 'ascending' : 'descending');
    const body = head.closest('table').tBodies[0];
    const rows = [...body.rows].map((row) => [value(row.cells[head.cellIndex]), row]);
    rows.sort(([a], [b]) => (up ? before(a, b) : before(b, a)));
    body.append(...rows.map(([, row]) => row));
  });
})();
