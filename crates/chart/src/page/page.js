  for (const hit of document.querySelectorAll('.panel .hit')) pointable(hit, () => [hit.dataset.label]);

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
