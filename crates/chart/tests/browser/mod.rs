//! The page in a real browser.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// A folder that is removed in the end.
struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        // What cannot be removed is left to the system.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Chromium by any of its names.
fn chromium() -> Option<&'static str> {
    let there = |name: &&str| {
        let version = Command::new(name).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
        version.is_ok_and(|status| status.success())
    };
    ["chromium", "chromium-browser", "google-chrome"].into_iter().find(there)
}

/// The page's elements after its scripts have run, and then this one.
fn opened(browser: &str, page: &str, script: &str) -> String {
    static RUN: std::sync::atomic::AtomicU32 = std::sync::atomic::AtomicU32::new(0);
    let run = RUN.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    let folder = Folder(std::env::temp_dir().join(format!("halfway-chart-browser-{}-{run}", std::process::id())));
    fs::create_dir_all(&folder.0).expect("a folder for the page");
    let file = folder.0.join("index.html");
    fs::write(&file, page.replace("</body>", &format!("<script>{script}</script></body>")))
        .expect("the page is written");
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--dump-dom"])
        .arg(format!("--user-data-dir={}", folder.0.join("profile").display()))
        .arg(format!("file://{}", file.display()))
        .output()
        .expect("the browser starts");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Without a browser these tests fail: the set-up of `cargo xtask test` installs one.
fn browser() -> &'static str {
    chromium().expect("chromium is installed; `cargo xtask test` does it")
}

/// What a script found out on the page, as it wrote it.
fn found(script: &str) -> serde_json::Value {
    found_on("index.html", script)
}

/// The same on another page.
fn found_on(page: &str, script: &str) -> serde_json::Value {
    let script = format!("const facts = {{}}; {script} document.body.dataset.facts = JSON.stringify(facts);");
    let dom = opened(browser(), &super::file(page), &script);
    let problem = dom.lines().find(|line| line.contains("id=\"problem\"")).unwrap_or_default();
    assert!(problem.contains("<p id=\"problem\" role=\"alert\" hidden=\"\"></p>"), "a script failed: {problem}");
    let (_, rest) = dom.split_once("data-facts=\"").expect("the script ran to its end");
    let (facts, _) = rest.split_once('"').expect("an attribute ends");
    serde_json::from_str(&facts.replace("&quot;", "\"")).expect("JSON")
}

#[test]
fn a_point_that_is_clicked_shows_its_pictures() {
    let facts = found(
        "const points = () => [...document.querySelectorAll('svg.front g[data-method]')];
         const chart = document.querySelector('svg.front').getBoundingClientRect();
         facts.points = points().length;
         facts.best = points().filter((point) => point.classList.contains('best')).length > 0;
         facts.wide = chart.width > 500 && chart.height > 250;
         facts.scrolls = document.documentElement.scrollWidth > document.documentElement.clientWidth;
         const point = points().find((point) => point.dataset.method === 'gouraud');
         point.querySelector('.hit').dispatchEvent(new MouseEvent('click', { bubbles: true }));
         const card = document.getElementById('card');
         facts.card = !card.hidden;
         facts.pictures = [...card.querySelectorAll('img')].map((image) => image.src.slice(0, 15));
         facts.title = card.querySelector('h3').textContent.split(',')[0];
         facts.command = card.querySelector('code').textContent.startsWith('halfway chart sphere --detail');",
    );
    // Two details of seven methods.
    let jpeg = "data:image/jpeg";
    let expected = serde_json::json!({
        "points": 14, "best": true, "wide": true, "scrolls": false, "card": true, "pictures": [jpeg, jpeg, jpeg],
        "title": "Gouraud", "command": true,
    });
    assert_eq!(facts, expected);
}

#[test]
fn points_are_filtered_zoomed_and_sorted() {
    let facts = found(
        "const points = () => [...document.querySelectorAll('svg.front g[data-method]')];
         const set = (name, value) => {
           const control = document.querySelector(`#controls [name=${name}]`);
           control.value = value;
           control.dispatchEvent(new Event(control.tagName === 'SELECT' ? 'change' : 'input'));
         };
         document.querySelector('#controls input[value=flat]').click();
         facts.flat = points().filter((point) => point.dataset.method === 'flat').length;
         facts.rest = points().length;
         set('words', 'infinite');
         facts.infinite = points().map((point) => point.dataset.method);
         set('words', '');
         set('scene', 'teapot-by-phong');
         facts.teapot = points().length;
         const seen = [...document.querySelectorAll('section[data-scene]')].filter((section) => !section.hidden);
         facts.seen = seen.map((section) => section.dataset.scene);
         const label = () => [...document.querySelectorAll('svg.front > text')].pop().textContent;
         facts.first = label().startsWith('RMS error of covered');
         set('error', '7');
         facts.flip = label();
         const place = () => points()[0].querySelector('path').getAttribute('transform');
         const before = place();
         document.querySelector('#controls button[title=\"zoom in\"]').click();
         facts.zoomed = place() !== before;
         document.querySelector('#controls button[title=\"the whole chart\"]').click();
         facts.whole = place() === before;
         const head = [...document.querySelectorAll('.points th')].find((head) => head.textContent === 'RMS');
         head.click();
         const rows = () => [...document.querySelectorAll('.points tbody tr')];
         const column = () => rows().map((row) => Number(row.cells[head.cellIndex].textContent));
         const sorted = (values) => values.every((value, i) => i === 0 || values[i - 1] <= value);
         facts.up = sorted(column());
         head.click();
         facts.down = sorted(column().reverse());",
    );
    let expected = serde_json::json!({
        "flat": 0, "rest": 12, "infinite": ["phong-infinite-viewer", "phong-infinite-viewer"], "teapot": 14,
        "seen": ["teapot-by-phong"], "first": true, "flip": "mean ꟻLIP of the whole picture", "zoomed": true, "whole": true,
        "up": true, "down": true,
    });
    assert_eq!(facts, expected);
}

#[test]
fn fingers_move_and_zoom_the_chart() {
    let facts = found(
        "const chart = () => document.querySelector('svg.front');
         const points = () => [...document.querySelectorAll('svg.front g[data-method]')];
         const places = () => points().map((point) =>
           point.querySelector('path').getAttribute('transform').match(/-?[0-9][-0-9.e]*/g).map(Number));
         const corner = chart().getBoundingClientRect();
         const send = (kind, id, x, y) => chart().dispatchEvent(new PointerEvent(kind, {
           pointerId: id, pointerType: 'touch', isPrimary: id === 1, button: kind === 'pointermove' ? -1 : 0, bubbles: true,
           clientX: corner.left + x, clientY: corner.top + y }));
         const far = (values) => Math.max(...values.map(Math.abs));
         const apart = (a, b) => far(a.flatMap(([x, y], i) => [x - b[i][0], y - b[i][1]]));
         facts.scrolls = getComputedStyle(chart().parentNode).touchAction;
         const first = places();
         // A tap that trembles leaves the chart as it is.
         send('pointerdown', 1, 200, 120); send('pointermove', 1, 202, 121); send('pointerup', 1, 202, 121);
         facts.tap = apart(places(), first);
         // One finger moves what is under it along.
         send('pointerdown', 1, 200, 120); send('pointermove', 1, 215, 125); send('pointermove', 1, 230, 105);
         facts.moved = apart(places(), first.map(([x, y]) => [x + 30, y - 15])) < 1e-6;
         send('pointerup', 1, 230, 105);
         send('pointermove', 1, 300, 200);
         facts.left = apart(places(), first.map(([x, y]) => [x + 30, y - 15])) < 1e-6;
         facts.zoomed = getComputedStyle(chart().parentNode).touchAction;
         document.querySelector('#controls button[title=\"the whole chart\"]').click();
         facts.whole = apart(places(), first) < 1e-6;
         // Two fingers, twice as far apart in the end, and their middle moved by (10, 20): from (220, 120) to
         // (230, 140).
         send('pointerdown', 1, 180, 120); send('pointerdown', 2, 260, 120);
         send('pointermove', 1, 150, 140); send('pointermove', 2, 310, 140);
         facts.pinched = apart(places(), first.map(([x, y]) => [230 + 2 * (x - 220), 140 + 2 * (y - 120)])) < 1e-6;
         // The one that stays goes on alone, without a jump.
         send('pointerup', 1, 150, 140);
         const before = places();
         send('pointermove', 2, 318, 140);
         facts.alone = apart(places(), before.map(([x, y]) => [x + 8, y])) < 1e-6;
         send('pointercancel', 2, 318, 140);
         // A mouse drags on what is no point, and a finger that taps a point shows it.
         points()[0].querySelector('.hit').dispatchEvent(new MouseEvent('click', { bubbles: true }));
         facts.card = !document.getElementById('card').hidden;",
    );
    let expected = serde_json::json!({
        "scrolls": "pan-y", "tap": 0, "moved": true, "left": true, "zoomed": "none", "whole": true, "pinched": true,
        "alone": true, "card": true,
    });
    assert_eq!(facts, expected);
}

/// What a screen reader says of a control or a link tells it from every other.
#[test]
fn every_control_and_link_of_a_failure_has_a_name_of_its_own() {
    let names = "const text = (element) => element.textContent.trim();
         const twice = (names) => names.filter((name, i) => name === '' || names.indexOf(name) !== i);
         const radios = [...document.querySelectorAll('input[type=radio]')];
         facts.radios = radios.length;
         facts.unnamed = twice(radios.map((radio) => [...radio.labels].map(text).join(' ')));
         facts.links = twice([...document.querySelectorAll('a')].map(text));
         facts.charts = [...document.querySelectorAll('.panel')].every((panel) => panel.ariaLabel !== '');
         const shown = () => [...document.querySelectorAll('main section > figure')].filter((figure) => !figure.hidden);
         facts.one = shown().length;
         radios[radios.length - 1]?.click();
         facts.chosen = radios.length === 0 || shown()[0].id === radios[radios.length - 1].value;";
    // Every page with a choice, and one without.
    let pages = || super::report().failures.iter();
    let alone = pages().find(|failure| failure.figures.len() == 1);
    for failure in pages().filter(|failure| failure.figures.len() > 1).chain(alone) {
        let radios = if failure.figures.len() > 1 { failure.figures.len() } else { 0 };
        let expected = serde_json::json!({
            "radios": radios, "unnamed": [], "links": [], "charts": true, "one": 1, "chosen": true,
        });
        assert_eq!(found_on(&format!("failure-{}.html", failure.id), names), expected, "{}", failure.id);
    }
}

#[test]
fn the_page_fits_a_phone() {
    let page = super::file("index.html");
    // A frame of a phone's width: a window without a screen cannot be so narrow.
    let folder = "<iframe id=\"phone\" style=\"width: 390px; height: 800px\"></iframe>";
    let inside = serde_json::to_string(&page).expect("a string").replace("</", "<\\/");
    let script = format!(
        "document.body.insertAdjacentHTML('beforeend', '{folder}');
         const phone = document.getElementById('phone').contentDocument;
         phone.open(); phone.write({inside}); phone.close();
         const page = phone.documentElement;
         facts.fits = page.scrollWidth <= page.clientWidth && page.clientWidth > 300;
         facts.chart = phone.querySelector('svg.front').getBoundingClientRect().width <= 390;"
    );
    assert_eq!(found(&script), serde_json::json!({ "fits": true, "chart": true }));
}

#[test]
fn failures_of_scripts_are_seen() {
    let dom = opened(browser(), &super::file("index.html"), "throw new Error('on purpose');");
    assert!(dom.contains("on purpose</p>"), "the page says that a script failed");
}
