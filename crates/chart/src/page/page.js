'use strict';
(() => {
  const cards = JSON.parse(document.getElementById('cards').textContent);
  const card = document.getElementById('card');
  let pinned = null;

  const element = (tag, text, ...children) => {
    const made = document.createElement(tag);
    if (text) made.textContent = text;
    made.append(...children);
    return made;
  };

  // Fills the card with what the point tells.
  const fill = ({ label, card: number }) => {
    const told = cards[number];
    if (!told) {
      card.replaceChildren(label);
      return;
    }
    const pictures = element('div', '', ...told.pictures.map(([caption, source]) => {
      const image = element('img');
      image.src = source;
      image.alt = '';
      return element('div', '', image, caption);
    }));
    pictures.className = 'pictures';
    const rows = told.rows.map(([name, value]) => element('div', '', element('dt', name), element('dd', value)));
    card.replaceChildren(element('h3', told.title), pictures, element('dl', '', ...rows));
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
    fill(hit.dataset);
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
    hit.addEventListener('click', (event) => {
      event.stopPropagation();
      pin(hit);
      show(hit);
    });
  }
  document.addEventListener('click', (event) => card.contains(event.target) || pin(null));
  document.addEventListener('keydown', (event) => event.key === 'Escape' && pin(null));

  // The buttons choose among the charts of a section. An address that ends in # and a chart's name shows that chart.
  const buttons = [...document.querySelectorAll('input[type=radio]')];
  const choose = () => {
    for (const button of buttons) document.getElementById(button.value).hidden = !button.checked;
    pin(null);
  };
  for (const button of buttons) {
    if (button.value === location.hash.slice(1)) button.checked = true;
    button.addEventListener('change', choose);
  }
  choose();
})();
