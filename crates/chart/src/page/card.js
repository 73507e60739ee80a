  // The card that tells what a point is: shown while it is pointed at, kept once it is clicked.
  const card = document.getElementById('card');
  let pinned = null;

  const element = (tag, text, ...children) => {
    const made = document.createElement(tag);
    if (text) made.textContent = text;
    made.append(...children);
    return made;
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

  const show = (hit, content) => {
    card.replaceChildren(...content());
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

  // Lets a mark of a chart be pointed at and clicked; `content` makes what the card shows.
  const pointable = (hit, content) => {
    hit.addEventListener('mouseenter', () => pinned || show(hit, content));
    hit.addEventListener('mouseleave', () => pinned || (card.hidden = true));
    const keep = (event) => {
      event.stopPropagation();
      pin(hit);
      show(hit, content);
    };
    hit.addEventListener('click', keep);
    hit.addEventListener('keydown', (event) => event.key === 'Enter' && keep(event));
  };

  document.addEventListener('click', (event) => card.contains(event.target) || pin(null));
  document.addEventListener('keydown', (event) => event.key === 'Escape' && pin(null));
