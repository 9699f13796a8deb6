//! Compound mechanisms: nanoseconds a joint and position, with and without velocities and accelerations.
//! Each answer is asserted before it is timed.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use linkwright::internals::files::linkage_file;
use linkwright::internals::mechanism::Linkage;
use linkwright::internals::mechanism::{Chain, Complex};
use std::f64::consts::TAU;
use std::hint::black_box;
use std::path::Path;

const POSITIONS: usize = 360;

fn shipped(name: &str) -> Chain {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("problems/linkages/{name}.toml"));
    match linkage_file::load_any(&path).expect("it is shipped").linkage {
        Linkage::Chain(chain) => *chain,
        _ => panic!("{name} is no chain"),
    }
}

fn chains(c: &mut Criterion) {
    let angles: Vec<f64> = (0..POSITIONS).map(|i| TAU * i as f64 / POSITIONS as f64).collect();
    let tabulated: Vec<Complex> = angles.iter().map(|a| Complex::from_polar(1.0, *a)).collect();
    for (name, lowest) in [("jansen-leg", -91.834), ("quick-return", 235.0)] {
        let chain = shipped(name);
        let (mut pose, mut motion) = (chain.pose(), chain.motion());
        let mut low = f64::MAX;
        for angle in &angles {
            assert!(chain.move_at(*angle, 1.0, 0.0, &mut motion).is_closed());
            low = low.min(motion.point(chain.trace()).expect("it is closed").im);
        }
        assert!((low - lowest).abs() < 5e-3, "{name}: {low}");

        // A joint is a point that moves: the crank's and one a stage.
        let joints = chain.stages() + 1;
        let mut group = c.benchmark_group(format!("{name}, a joint and position"));
        group.throughput(Throughput::Elements((POSITIONS * joints) as u64));
        group.bench_function("position", |b| {
            b.iter(|| {
                for angle in &angles {
                    black_box(chain.position(black_box(*angle), &mut pose));
                }
            });
        });
        group.bench_function("position, tabulated angles", |b| {
            b.iter(|| {
                for crank in &tabulated {
                    black_box(chain.position_toward(black_box(*crank), &mut pose));
                }
            });
        });
        group.bench_function("position, velocity, acceleration", |b| {
            b.iter(|| {
                for angle in &angles {
                    black_box(chain.move_at(black_box(*angle), 1.0, 0.0, &mut motion));
                }
            });
        });
        group.finish();
    }
}

criterion_group!(benches, chains);
criterion_main!(benches);
