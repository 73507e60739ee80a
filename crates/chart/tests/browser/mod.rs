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
    let script = format!("const facts = {{}}; {script} document.body.dataset.facts = JSON.stringify(facts);");
    let dom = opened(browser(), &super::file("index.html"), &script);
    assert!(dom.contains("<p id=\"problem\" role=\"alert\" hidden=\"\"></p>"), "no script failed");
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
