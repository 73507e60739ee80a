//! `halfway bench s1` and the like: the table of one scene.

use halfway::prelude::*;
use halfway::render::{Adapter, RenderError};
use halfway_chart::timing::{FRAME_TIME, Machine, Spread, median_ratio};
use serde_json::json;

use super::app::Timed;
use super::args::{BenchArgs, BenchShading};
use super::cpu::{self, CpuTimes, OWN_TIME};
use super::facts::{counters, print_facts, spread};
use super::own_process::{FirstFrame, first_frame};
use crate::failure::Failure;
use crate::tolerance;

/// The measurements of one shading.
struct Row {
    mode: BenchShading,
    frame: Spread,
    to_constant: f64,
    to_exact: f64,
    cpu: CpuTimes,
    report: FrameReport,
    warm: FirstFrame,
    cold: Option<FirstFrame>,
}

pub(super) fn run(args: &BenchArgs, timed: &Timed) -> Result<(), Failure> {
    let modes = BenchShading::ALL;
    let apps: Result<Vec<App>, Failure> = modes.iter().map(|mode| timed.app(args, *mode)).collect();
    let mut apps = apps?;
    let times = cpu::timed(&mut apps, args.rounds)?;
    let adapter = Adapter::from_world(apps[0].world()).ok_or(RenderError::NoAdapter)?;
    let machine = Machine::new(&adapter);
    let reports = apps.iter().map(|app| app.world().resource::<FrameReport>().clone());
    let mut rows = Vec::new();
    for ((&mode, report), (own, cpu)) in modes.iter().zip(reports).zip(&times) {
        rows.push(Row {
            mode,
            frame: Spread::from_values(own),
            to_constant: median_ratio(own, &times[0].0),
            to_exact: median_ratio(own, &times[times.len() - 1].0),
            cpu: cpu.clone(),
            report,
            warm: first_frame(mode, false)?,
            cold: args.cold.then(|| first_frame(mode, true)).transpose()?,
        });
    }
    if args.json {
        print_json(args, timed, &machine, &rows);
    } else {
        print_table(args, timed, &machine, &rows);
    }
    Ok(())
}

fn print_table(args: &BenchArgs, timed: &Timed, machine: &Machine, rows: &[Row]) {
    let size = timed.size(args);
    let octahedra = if args.octahedra { ", spheres as octahedra" } else { "" };
    println!("scene: {}{octahedra}, {} × {} pixels, {} rounds", timed.name(), size.x, size.y, args.rounds);
    println!("tolerance: {}", tolerance::describe(args.tolerance.or(Tolerance::EXACT)));
    print_facts(machine);
    println!("\n{FRAME_TIME}\n{OWN_TIME}\n");
    let cold = if args.cold { ["first frame, no shaders kept, ms | ", "---|"] } else { [""; 2] };
    println!(
        "| shading | frame, ms: median | min | max | × constant | × exact Phong | own CPU, ms | first frame, ms | \
         {}peak memory, MB |",
        cold[0]
    );
    println!("|---|---|---|---|---|---|---|---|{}---|", cold[1]);
    for Row { mode, frame, to_constant, to_exact, cpu, report: _, warm, cold } in rows {
        let Spread { median, min, max, .. } = frame;
        let cold = cold.as_ref().map(|cold| format!("{:.0} | ", cold.ms)).unwrap_or_default();
        println!(
            "| {} | {median:.2} | {min:.2} | {max:.2} | {to_constant:.2} | {to_exact:.2} | {:.2} | {:.0} | {cold}{:.0} |",
            mode.name(),
            cpu.own_ms(),
            warm.ms,
            warm.peak_mb
        );
    }
}

fn print_json(args: &BenchArgs, timed: &Timed, machine: &Machine, rows: &[Row]) {
    let size = timed.size(args);
    let Tolerance { steps, pixels } = args.tolerance.or(Tolerance::EXACT);
    let rows: Vec<_> = rows
        .iter()
        .map(|row| {
            let mut value = json!({
                "shading": row.mode.name(),
                "frame_ms": row.frame.median,
                "frame_ms_spread": spread(&row.frame),
                "ratio_to_constant": row.to_constant,
                "ratio_to_exact_phong": row.to_exact,
                "first_frame_ms": row.warm.ms,
                "peak_mb": row.warm.peak_mb,
                "cpu_ms": row.cpu.json(),
                "report": counters(&row.report),
            });
            if let Some(cold) = &row.cold {
                value["first_frame_cold_ms"] = json!(cold.ms);
            }
            value
        })
        .collect();
    println!(
        "{}",
        json!({
            "scene": timed.name(),
            "octahedra": args.octahedra,
            "size": size.to_array(),
            "tolerance": { "steps": steps, "pixels": pixels },
            "rounds": args.rounds,
            "machine": machine,
            "frame": FRAME_TIME,
            "rows": rows,
        })
    );
}
