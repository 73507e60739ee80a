//! `halfway bench features`: what each feature of lighting costs, once a vertex and once a pixel.

use halfway::prelude::*;
use halfway::render::Adapter;
use halfway_chart::timing::{FRAME_TIME, Machine, Spread, median, median_ratio, settle};
use serde_json::json;

use super::app::finish;
use super::args::BenchArgs;
use super::cpu::{self, CpuTimes};
use super::facts::{counters, machine, print_facts, spread};
use crate::failure::Failure;
use crate::scenery::features::{Feature, FeatureStage};

/// What one stage costs under one feature.
struct Cost {
    frame: Spread,
    /// To the baseline.
    ratio: f64,
    /// What a light costs at a vertex or pixel, where that can be said.
    per_light_ns: Option<f64>,
    cpu: CpuTimes,
    report: FrameReport,
}

pub(super) fn run(args: &BenchArgs) -> Result<(), Failure> {
    if args.size.size.is_some()
        || args.octahedra
        || args.tolerance.given().is_some()
        || args.cold
        || args.once.is_some()
    {
        return Err("bench features: expected no option but --adapter, --rounds and --json".to_owned().into());
    }
    let features = Feature::all();
    // One for all, so that two dozen of them need not share the machine.
    let adapter = args.adapter.choice().open()?;
    let [vertex, fragment] = FeatureStage::ALL.map(|stage| measure(&features, stage, &adapter, args.rounds));
    let (vertex, fragment) = (vertex?, fragment?);
    let machine = Machine::new(&adapter);
    let rows: Vec<_> = features.iter().zip(vertex.iter().zip(&fragment)).collect();
    if args.json {
        print_json(args, &machine, &rows);
    } else {
        print_table(args, &machine, &rows);
    }
    Ok(())
}

/// Every feature at one stage, all in turns.
fn measure(features: &[Feature], stage: FeatureStage, adapter: &Adapter, rounds: u32) -> Result<Vec<Cost>, Failure> {
    let mut apps: Vec<App> = features.iter().map(|feature| app(*feature, stage, adapter)).collect();
    for app in &mut apps {
        settle(app)?;
    }
    let timed = cpu::timed(&mut apps.iter_mut().collect::<Vec<_>>(), rounds)?;
    let (times, cpu): (Vec<_>, Vec<_>) = timed.into_iter().unzip();
    let baseline = features.iter().position(|feature| *feature == Feature::BASELINE).unwrap_or(0);
    let unlit = features.iter().position(|feature| feature.lights.count() == 0);
    let costs = features.iter().zip(&apps).zip(times.iter().zip(cpu)).map(|((feature, app), (own, cpu))| {
        let evaluations = f64::from(feature.lights.count()) * f64::from(stage.evaluations());
        let unlit = unlit.filter(|_| feature.is_about_lights());
        // Within a round, as ratios are.
        let more = unlit.map(|unlit| own.iter().zip(&times[unlit]).map(|(a, b)| a - b).collect::<Vec<_>>());
        Cost {
            frame: Spread::of(own),
            ratio: median_ratio(own, &times[baseline]),
            per_light_ns: more.map(|more| median(&more) * 1e6 / evaluations),
            cpu,
            report: app.world().resource::<FrameReport>().clone(),
        }
    });
    Ok(costs.collect())
}

fn app(feature: Feature, stage: FeatureStage, adapter: &Adapter) -> App {
    let mut app = App::new();
    adapter.clone().insert_into(app.world_mut());
    app.add_plugins((HalfwayPlugins::headless(stage.size()), feature.at(stage)));
    finish(&mut app);
    app
}

type Row<'a> = (&'a Feature, (&'a Cost, &'a Cost));

fn print_table(args: &BenchArgs, machine: &Machine, rows: &[Row<'_>]) {
    println!("the cost of features, {} rounds", args.rounds);
    print_facts(machine);
    println!("\n{FRAME_TIME}\nMedians; × is to the baseline, the median of the ratios within a round.");
    if let Some((_, (vertex, fragment))) = rows.first() {
        for (what, stage, cost) in
            [("vertex: Gouraud", FeatureStage::Vertex, vertex), ("pixel: Phong", FeatureStage::Fragment, fragment)]
        {
            let UVec2 { x, y } = stage.size();
            let (triangles, count) = (cost.report.triangles, stage.evaluations());
            println!(
                "Once a {what} shading, {triangles} triangles on {x} × {y} pixels, each light {count} times a frame."
            );
        }
    }
    println!("A light's cost is what the frame takes longer than with no lights, by lights and vertices or pixels.\n");
    println!("| | vertex, ms | × | a light, ns | pixel, ms | × | a light, ns |");
    println!("|---|---|---|---|---|---|---|");
    for (feature, (vertex, fragment)) in rows {
        let cells = [vertex, fragment].map(|Cost { frame, ratio, per_light_ns, .. }| {
            let light = per_light_ns.map_or_else(|| "–".to_owned(), |ns| format!("{ns:.1}"));
            format!("{:.2} | {ratio:.2} | {light}", frame.median)
        });
        println!("| {} | {} | {} |", feature.name, cells[0], cells[1]);
    }
}

fn print_json(args: &BenchArgs, machine: &Machine, rows: &[Row<'_>]) {
    let cost = |it: &Cost| {
        json!({
            "frame_ms": it.frame.median,
            "frame_ms_spread": spread(&it.frame),
            "ratio_to_baseline": it.ratio,
            "light_ns": it.per_light_ns,
            "cpu_ms": it.cpu.json(),
            "report": counters(&it.report),
        })
    };
    let rows: Vec<_> = rows
        .iter()
        .map(|(feature, (vertex, fragment))| {
            json!({
                "feature": feature.name,
                "lights": feature.lights.count(),
                "vertex": cost(vertex),
                "fragment": cost(fragment),
            })
        })
        .collect();
    let stage = |stage: FeatureStage| json!({ "size": stage.size().to_array(), "evaluations": stage.evaluations() });
    println!(
        "{}",
        json!({
            "rounds": args.rounds,
            "machine": self::machine(machine),
            "frame": FRAME_TIME,
            "stages": { "vertex": stage(FeatureStage::Vertex), "fragment": stage(FeatureStage::Fragment) },
            "rows": rows,
        })
    );
}
