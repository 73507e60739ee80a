//! `halfway bench growth`: the renderer's own work, the drawing and the memory, over what a scene has.

use std::process::Command;

use halfway::prelude::*;
use halfway_chart::figure::{Axis, Figure, Marker, Panel, Point, Series, Stroke, Style, svg};
use halfway_chart::timing::{Machine, median};
use serde_json::{Value, json};

use super::app::finish;
use super::args::BenchArgs;
use super::cpu::{self, OWN_TIME};
use super::facts::print_facts;
use super::own_process::peak_kb;
use crate::failure::Failure;
use crate::scenery::growth::{Growing, Growth};

/// The measured quantities of a point: names, units, and styles in the chart.
const QUANTITIES: [(&str, &str, [u8; 3], Marker); 3] = [
    ("own_ms", "own CPU, ms", [0, 90, 180], Marker::Circle),
    ("draw_ms", "drawing, ms", [200, 80, 0], Marker::Square),
    ("peak_mb", "peak memory, MB", [90, 90, 90], Marker::Triangle),
];

/// The points of a scene that grows: counts, each with its quantities.
type Line = (Growth, Vec<(u32, [f64; 3])>);

/// A point, or why there is none.
type Measured = Result<[f64; 3], String>;

/// Measures each point in a process of its own, so that memory is that of the point alone.
pub(super) fn run(args: &BenchArgs) -> Result<(), Failure> {
    args.expect_no_scene("growth")?;
    if let Some(point) = args.point {
        return here(args, point);
    }
    let machine = Machine::new(&args.adapter.choice().open()?);
    let most = memory_mb().map_or(f64::INFINITY, |all| 0.5 * all);
    let mut lines: Vec<Line> = Vec::new();
    let mut stopped = Vec::new();
    for by in Growth::ALL {
        let mut points: Vec<(u32, [f64; 3])> = Vec::new();
        for count in by.counts() {
            // Four times as many may take four times as much.
            if let Some((_, [.., peak])) = points.last().filter(|(_, [.., peak])| 4.0 * peak > most) {
                stopped.push(format!("{} {count}: not tried, beside {peak:.0} MB for a quarter of it", by.name()));
                break;
            }
            match elsewhere(Growing { by, count })? {
                Ok(point) => points.push((count, point)),
                Err(reason) => {
                    stopped.push(format!("{} {count}: {reason}", by.name()));
                    break;
                }
            }
        }
        lines.push((by, points));
    }
    if let Some(path) = &args.output {
        let size = svg::Size { width: 1100, row: 320 };
        let failed = |error| Failure::new(1, format!("{}: {error}", path.display()));
        std::fs::write(path, svg::figure(&figure(&lines), size)).map_err(failed)?;
    }
    if args.json {
        let line = |(by, points): &Line| {
            let point = |(count, values): &(u32, [f64; 3])| {
                let named = QUANTITIES.iter().zip(values).map(|((name, ..), value)| ((*name).to_owned(), json!(value)));
                Value::Object(std::iter::once(("count".to_owned(), json!(count))).chain(named).collect())
            };
            json!({ "by": by.name(), "slopes": slopes(points), "points": points.iter().map(point).collect::<Vec<_>>() })
        };
        let lines: Vec<_> = lines.iter().map(line).collect();
        println!("{}", json!({ "rounds": args.rounds, "machine": machine, "lines": lines, "stopped": stopped }));
        return Ok(());
    }
    println!("growth, {} rounds", args.rounds);
    print_facts(&machine);
    println!("\n{OWN_TIME}\n");
    println!("| by | count | own CPU, ms | drawing, ms | peak memory, MB |\n|---|---|---|---|---|");
    for (by, points) in &lines {
        for (count, [own, draw, peak]) in points {
            println!("| {} | {count} | {own:.3} | {draw:.2} | {peak:.0} |", by.name());
        }
        let [own, draw, peak] =
            slopes(points).map(|slope| slope.map_or("–".to_owned(), |slope| format!("{slope:.2}")));
        println!("| {} | slope of the last two decades | {own} | {draw} | {peak} |", by.name());
    }
    for line in stopped {
        println!("\n{line}");
    }
    Ok(())
}

/// In a process of its own: measures, and prints the values.
fn here(args: &BenchArgs, point: Growing) -> Result<(), Failure> {
    let adapter = args.adapter.choice().open()?;
    let mut app = App::new();
    adapter.insert_into(app.world_mut());
    app.add_plugins((HalfwayPlugins::headless(point.size()), point));
    finish(&mut app);
    let timed = cpu::timed(std::slice::from_mut(&mut app), args.rounds)?;
    let (own, draw): (Vec<f64>, Vec<f64>) =
        timed.iter().flat_map(|(_, cpu)| cpu.own_of_each_ms().into_iter().zip(cpu.draw_of_each_ms())).unzip();
    println!("{} {} {}", median(&own), median(&draw), peak_kb() as f64 / 1024.0);
    Ok(())
}

/// Measures a point in a process of its own.
fn elsewhere(Growing { by, count }: Growing) -> Result<Measured, Failure> {
    let failed = |error: std::io::Error| Failure::new(1, error);
    let mut command = Command::new(std::env::current_exe().map_err(failed)?);
    command.args(["bench", "--point", &format!("{}:{count}", by.name())]).args(std::env::args_os().skip(2));
    let output = command.output().map_err(failed)?;
    let text = String::from_utf8_lossy(&output.stdout);
    let values: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    Ok(<[f64; 3]>::try_from(values).map_err(|_| match String::from_utf8_lossy(&output.stderr).trim() {
        "" => output.status.to_string(),
        said => said.to_owned(),
    }))
}

/// The memory of the machine in MB; `None` where the system does not say.
fn memory_mb() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    Some(line.split_whitespace().next()?.parse::<f64>().ok()? / 1024.0)
}

/// The exponent of each quantity over the last two decades of counts: 1 where twice as many take twice as much. By least
/// squares between logarithms; `None` for less than three points.
fn slopes(points: &[(u32, [f64; 3])]) -> [Option<f64>; 3] {
    let last = points.last().map_or(0.0, |(count, _)| f64::from(*count));
    let decades: Vec<_> = points.iter().filter(|(count, _)| 100.0 * f64::from(*count) >= last).collect();
    std::array::from_fn(|quantity| {
        let logs = decades.iter().map(|(count, values)| [f64::from(*count).ln(), values[quantity].ln()]);
        let logs: Vec<[f64; 2]> = logs.filter(|[_, value]| value.is_finite()).collect();
        let count = logs.len() as f64;
        let mean = |axis: usize| logs.iter().map(|log| log[axis]).sum::<f64>() / count;
        let [x, y] = [mean(0), mean(1)];
        let sums = logs.iter().map(|log| [(log[0] - x) * (log[1] - y), (log[0] - x).powi(2)]);
        let [both, square] = sums.fold([0.0; 2], |sum, term| [sum[0] + term[0], sum[1] + term[1]]);
        (logs.len() >= 3).then_some(both / square)
    })
}

/// A panel for each number that grows.
fn figure(lines: &[Line]) -> Figure {
    let panels = lines.iter().map(|(by, points)| {
        let series = QUANTITIES.iter().enumerate().map(|(quantity, &(_, name, color, marker))| Series {
            name: name.to_owned(),
            style: Style { color, marker: Some(marker), filled: true, stroke: Stroke::Solid },
            points: points
                .iter()
                .map(|(count, values)| Point::new(f64::from(*count), values[quantity], format!("{count}")))
                .collect(),
        });
        Panel::new(by.name(), series.collect())
    });
    Figure {
        id: "growth".to_owned(),
        name: "growth".to_owned(),
        title: "The cost of a frame over what a scene has".to_owned(),
        x: Axis::log("how many"),
        y: Axis::log("ms, or MB"),
        panels: panels.collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_exponents_of_the_last_two_decades() {
        let power = |count: u32| [f64::from(count), f64::from(count).powf(1.5), 7.0];
        let mut points: Vec<_> = [1000, 4000, 16_000, 64_000].map(|count| (count, power(count))).into();
        // Before the last two decades.
        points.insert(0, (10, [500.0; 3]));
        let [own, draw, peak] = slopes(&points).map(|slope| slope.expect("four points"));
        assert!((own - 1.0).abs() < 1e-9 && (draw - 1.5).abs() < 1e-9 && peak.abs() < 1e-9, "{own} {draw} {peak}");
        assert_eq!(slopes(&points[..2]), [None; 3]);
    }

    #[test]
    fn points_are_read_as_they_are_written() {
        for by in Growth::ALL {
            let largest = by.counts().last().expect("a count");
            assert_eq!(format!("{}:{largest}", by.name()).parse(), Ok(Growing { by, count: largest }));
        }
        for wrong in ["lights", "lights:0", "lights:many", "clouds:7"] {
            assert!(wrong.parse::<Growing>().is_err(), "{wrong}");
        }
    }
}
