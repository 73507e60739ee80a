//! The page in a real browser: only `cargo xtask test --all` runs these tests, by the name of this module.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use crate::report::{file, report};

/// A temporary folder, removed at the end.
struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        // If it cannot be removed, the system will.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Chromium by any of its names; without it these tests fail.
fn browser() -> &'static str {
    let there = |name: &&str| {
        let version = Command::new(name).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
        version.is_ok_and(|status| status.success())
    };
    let found = ["chromium", "chromium-browser", "google-chrome"].into_iter().find(there);
    found.expect("chromium is installed; `cargo xtask test --all` does it")
}

/// The page's elements after its scripts have run, and then this one.
fn opened(page: &str, script: &str) -> String {
    static RUN: std::sync::atomic::AtomicU32 = std::sync::atomic::AtomicU32::new(0);
    let run = RUN.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    let folder = Folder(std::env::temp_dir().join(format!("halfway-chart-browser-{}-{run}", std::process::id())));
    fs::create_dir_all(&folder.0).expect("a folder for the page");
    let file = folder.0.join("index.html");
    fs::write(&file, page.replace("</body>", &format!("<script>{script}</script></body>")))
        .expect("the page is written");
    let output = Command::new(browser())
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--dump-dom"])
        .arg(format!("--user-data-dir={}", folder.0.join("profile").display()))
        .arg(format!("file://{}", file.display()))
        .output()
        .expect("the browser starts");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// The result of a script on a page, as it wrote it.
fn found(page: &str, script: &str) -> serde_json::Value {
    let script = format!("const facts = {{}}; {script} document.body.dataset.facts = JSON.stringify(facts);");
    let dom = opened(file(page), &script);
    let problem = dom.lines().find(|line| line.contains("id=\"problem\"")).unwrap_or_default();
    assert!(problem.contains("<p id=\"problem\" role=\"alert\" hidden=\"\"></p>"), "a script failed: {problem}");
    let (_, rest) = dom.split_once("data-facts=\"").expect("the script ran to its end");
    let (facts, _) = rest.split_once('"').expect("an attribute ends");
    serde_json::from_str(&facts.replace("&quot;", "\"")).expect("JSON")
}

#[test]
fn a_point_that_is_clicked_shows_its_pictures() {
    let facts = found(
        "index.html",
        "const figure = document.getElementById('front-sphere-rms');
         const panel = figure.querySelector('.panel');
         const points = [...panel.querySelectorAll('.hit')];
         facts.points = points.length;
         facts.wide = panel.getBoundingClientRect().width > 300;
         facts.scrolls = document.documentElement.scrollWidth > document.documentElement.clientWidth;
         const point = points.find((point) => point.dataset.label.startsWith('Gouraud, '));
         point.dispatchEvent(new MouseEvent('click', { bubbles: true }));
         const card = document.getElementById('card');
         facts.card = !card.hidden;
         facts.pictures = [...card.querySelectorAll('img')].map((image) => image.src.slice(0, 15));
         facts.title = card.querySelector('h3').textContent.split(',')[0];
         facts.command = card.querySelector('code').textContent.startsWith('halfway chart sphere --detail');
         document.body.click();
         facts.gone = card.hidden;",
    );
    // Two details of seven methods.
    let jpeg = "data:image/jpeg";
    let expected = serde_json::json!({
        "points": 14, "wide": true, "scrolls": false, "card": true, "pictures": [jpeg, jpeg, jpeg],
        "title": "Gouraud", "command": true, "gone": true,
    });
    assert_eq!(facts, expected);
}

#[test]
fn series_are_hidden_charts_chosen_and_tables_sorted() {
    let facts = found(
        "index.html",
        "const figure = document.getElementById('front-sphere-rms');
         const flat = () => [...figure.querySelectorAll('[data-series=flat]')];
         const entry = [...figure.querySelectorAll('.legend button')].find((entry) => entry.value === 'flat');
         facts.there = flat().length > 2 && flat().every((part) => part.style.display === '');
         entry.click();
         facts.hidden = flat().every((part) => part.style.display === 'none');
         entry.click();
         facts.again = flat().every((part) => part.style.display === '');
         const section = figure.closest('section');
         section.querySelector('input[value=front-sphere-largest]').click();
         const shown = [...section.querySelectorAll('figure[id]')].filter((figure) => !figure.hidden);
         facts.shown = shown.map((figure) => figure.id);
         const table = section.querySelector('table');
         const head = [...table.querySelectorAll('th')].find((head) => head.textContent === 'ms');
         head.click();
         const column = () => [...table.tBodies[0].rows].map((row) => Number(row.cells[head.cellIndex].textContent));
         const sorted = (values) => values.every((value, i) => i === 0 || values[i - 1] <= value);
         facts.up = sorted(column());
         head.click();
         facts.down = sorted(column().reverse());",
    );
    let expected = serde_json::json!({
        "there": true, "hidden": true, "again": true, "shown": ["front-sphere-largest"], "up": true, "down": true,
    });
    assert_eq!(facts, expected);
}

/// Every control and link has a distinct name for screen readers.
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
    let pages = || report().failures.iter();
    let alone = pages().find(|failure| failure.figures.len() == 1);
    for failure in pages().filter(|failure| failure.figures.len() > 1).chain(alone) {
        let radios = if failure.figures.len() > 1 { failure.figures.len() } else { 0 };
        let expected = serde_json::json!({
            "radios": radios, "unnamed": [], "links": [], "charts": true, "one": 1, "chosen": true,
        });
        assert_eq!(found(&format!("failure-{}.html", failure.id), names), expected, "{}", failure.id);
    }
}

#[test]
fn the_page_fits_a_phone() {
    // A frame of a phone's width: a window without a screen cannot be so narrow.
    let folder = "<iframe id=\"phone\" style=\"width: 390px; height: 800px\"></iframe>";
    let inside = serde_json::to_string(file("index.html")).expect("a string").replace("</", "<\\/");
    let script = format!(
        "document.body.insertAdjacentHTML('beforeend', '{folder}');
         const phone = document.getElementById('phone').contentDocument;
         phone.open(); phone.write({inside}); phone.close();
         const page = phone.documentElement;
         facts.fits = page.scrollWidth <= page.clientWidth && page.clientWidth > 300;
         facts.chart = phone.querySelector('.panel svg').getBoundingClientRect().width <= 390;"
    );
    assert_eq!(found("index.html", &script), serde_json::json!({ "fits": true, "chart": true }));
}

#[test]
fn failures_of_scripts_are_seen() {
    let dom = opened(file("index.html"), "throw new Error('on purpose');");
    assert!(dom.contains("on purpose</p>"), "the page says that a script failed");
}
