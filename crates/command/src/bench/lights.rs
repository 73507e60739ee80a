//! `halfway bench lights`: the CPU's cost of a light for each patch that it touches, and of a light that touches
//! nothing.

use halfway::prelude::*;
use halfway_chart::timing::{Machine, median};
use serde_json::json;

use super::app::finish;
use super::args::BenchArgs;
use super::cpu::{self, OWN_TIME};
use super::facts::{counters, print_facts};
use crate::failure::Failure;
use crate::scenery::many_lights::{ManyLights, SIZE};

/// Nine lights, so that they are not compiled in, none of which touches anything; some that touch everything; and many
/// apart.
const ROWS: [ManyLights; 3] = [
    ManyLights { touching: 0, apart: 9 },
    ManyLights { touching: 12, apart: 0 },
    ManyLights { touching: 12, apart: 19_988 },
];

pub(super) fn run(args: &BenchArgs) -> Result<(), Failure> {
    args.expect_no_scene("lights")?;
    let adapter = args.adapter.choice().open()?;
    let mut apps = ROWS.map(|scene| {
        let mut app = App::new();
        adapter.clone().insert_into(app.world_mut());
        app.add_plugins((HalfwayPlugins::headless(SIZE), scene));
        finish(&mut app);
        app
    });
    let timed = cpu::timed(&mut apps, args.rounds)?;
    let own: Vec<Vec<f64>> = timed.iter().map(|(_, cpu)| cpu.own_of_each_ms()).collect();
    let reports = apps.each_ref().map(|app| app.world().resource::<FrameReport>().clone());
    let [_, few, many] = &reports;
    let patches = f64::from(few.patches - few.patches_culled);
    // Differences within a round, as for ratios.
    let more = |a: usize, b: usize| median(&own[a].iter().zip(&own[b]).map(|(a, b)| a - b).collect::<Vec<_>>()) * 1e6;
    let per_pair = more(1, 0) / (patches * f64::from(few.lights));
    let per_light = more(2, 1) / f64::from(many.lights - few.lights);
    let machine = Machine::new(&adapter);
    let median_ms = |row: usize| median(&own[row]);
    if args.json {
        let rows = ROWS.iter().zip(&reports).zip(&timed).map(|((scene, report), (_, cpu))| {
            json!({ "touching": scene.touching, "apart": scene.apart, "cpu_ms": cpu.json(), "report": counters(report) })
        });
        let rows: Vec<_> = rows.collect();
        println!(
            "{}",
            json!({
                "rounds": args.rounds,
                "machine": machine,
                "pair_ns": per_pair,
                "light_ns": per_light,
                "rows": rows,
            })
        );
        return Ok(());
    }
    println!("the cost of lights, {} rounds", args.rounds);
    print_facts(&machine);
    println!("\n{OWN_TIME}\nThe camera moves; {patches} patches are seen.\n");
    println!("| lights that touch all patches | that touch none | own CPU, ms | pairs looked at |");
    println!("|---|---|---|---|");
    for (row, (scene, report)) in ROWS.iter().zip(&reports).enumerate() {
        let ManyLights { touching, apart } = scene;
        println!("| {touching} | {apart} | {:.2} | {} |", median_ms(row), report.light_pairs);
    }
    println!(
        "\nA pair of a patch and a light that touch costs {per_pair:.1} ns, a light that touches nothing {per_light:.1} ns."
    );
    Ok(())
}
