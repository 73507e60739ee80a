//! The page in a real browser, where one is installed.

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

#[test]
fn the_page_works_in_a_browser() {
    let Some(browser) = chromium() else {
        eprintln!("skipped: chromium is not installed");
        return;
    };
    let page = super::file("index.html");
    // How many points are seen and how large the first chart is; then one is clicked, and another chart is chosen.
    let dom = opened(
        browser,
        &page,
        "const seen = () => [...document.querySelectorAll('.hit')].filter((hit) => hit.getClientRects().length).length;
         const main = document.getElementById('error-rms').getBoundingClientRect();
         const facts = { first: seen(), wide: main.width > 600 && main.height > 300 };
         facts.scrolls = document.documentElement.scrollWidth > document.documentElement.clientWidth;
         document.querySelector('.hit[data-card]').dispatchEvent(new MouseEvent('click', { bubbles: true }));
         facts.card = !document.getElementById('card').hidden;
         facts.pictures = document.querySelectorAll('#card img').length;
         document.querySelector('input[value=error-flip]').click();
         facts.flip = !document.getElementById('error-flip').hidden && document.getElementById('error-rms').hidden;
         document.body.dataset.facts = JSON.stringify(facts);",
    );
    // 48 points of the main chart, 2 objects × 2 materials × 3 shadings × 2 errors × 2 levels, 4 lines of 2 frames; 16 steps
    // of 4 looks, and in each of 6 panels a line of 2 ends.
    let facts = r#"{"first":180,"wide":true,"scrolls":false,"card":true,"pictures":2,"flip":true}"#;
    assert!(dom.contains(&facts.replace('"', "&quot;")), "{}", dom.chars().rev().take(600).collect::<String>());
    assert!(dom.contains("<p id=\"problem\" role=\"alert\" hidden=\"\"></p>"), "no script failed");
}

#[test]
fn failures_of_scripts_are_seen() {
    let Some(browser) = chromium() else {
        eprintln!("skipped: chromium is not installed");
        return;
    };
    let dom = opened(browser, &super::file("index.html"), "throw new Error('on purpose');");
    assert!(dom.contains("on purpose</p>"), "the page says that a script failed");
}
