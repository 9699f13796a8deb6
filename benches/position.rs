//! The position kernels beside the machine's bound (the square root and the division that a position needs; a
//! slider-crank's needs the root alone) and, of the four-bar, beside a textbook solver by angles, in one run. Each is
//! asserted to give the answer before it is timed.

#[path = "../tests/common/coupler_points.rs"]
mod coupler_points;

use coupler_points::CouplerPoints;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use linkwright::internals::mechanism::four_bar::position::{Kernel, LanePosition};
use linkwright::internals::mechanism::four_bar::positions::{JointColumns, LaneKernel};
use linkwright::internals::mechanism::{
    AssemblyMode, Complex, CouplerSide, FourBar, InvertedSliderCrank, NaturalCoordinates, SliderCrank,
    SliderLinkage, xy,
};
use linkwright::internals::numbers::arithmetic::lane::Lane;
use linkwright::internals::numbers::arithmetic::sine::sin_cos;
use std::f64::consts::TAU;
use std::hint::black_box;

/// No multiple of 512: columns that lie a multiple of 4 KiB apart would make loads wait for stores of others.
const POSITIONS: usize = 600;

type Group<'a> = criterion::BenchmarkGroup<'a, criterion::measurement::WallTime>;

/// Returns the name of the widest vector instructions that this machine has.
fn vector_unit() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    {
        if std::arch::is_x86_feature_detected!("avx512dq") {
            return "AVX-512";
        }
        if std::arch::is_x86_feature_detected!("avx2") {
            return "AVX2";
        }
    }
    "baseline"
}

fn linkage() -> FourBar {
    FourBar::new(NaturalCoordinates {
        crank_pivot: [0.0, 0.0],
        follower_pivot: [4.0, 1.0],
        crank: 2.0,
        coupler: 5.0,
        follower: 5.0,
        crank_side: 5.0,
        follower_side: 5.0,
        assembly: AssemblyMode::Plus,
        side: CouplerSide::Plus,
    })
    .expect("Romero's example is a linkage")
}

/// The textbook way: Freudenstein's half-angle formula for the coupler's angle, then its cosine and sine.
fn textbook(linkage: &FourBar, angle: f64) -> [f64; 2] {
    let [g, a, b, c] = linkage.links();
    let theta2 = angle - linkage.ground_angle();
    let k1 = g / a;
    let k4 = g / b;
    let k5 = (c * c - g * g - a * a - b * b) / (2.0 * a * b);
    let (sin, cos) = theta2.sin_cos();
    let d = cos - k1 + k4 * cos + k5;
    let e = -2.0 * sin;
    let f = k1 + (k4 - 1.0) * cos + k5;
    let root = (e * e - 4.0 * d * f).max(0.0).sqrt();
    let theta3 = 2.0 * ((-e - root) / (2.0 * d)).atan();
    let offset = linkage.coupler_offset();
    let coupler = theta3 + linkage.ground_angle() + offset.arg();
    let pivot = linkage.crank_pivot();
    [
        pivot.re + a * angle.cos() + offset.norm() * coupler.cos(),
        pivot.im + a * angle.sin() + offset.norm() * coupler.sin(),
    ]
}

fn positions(c: &mut Criterion) {
    let linkage = linkage();
    let kernel = Kernel::new(&linkage);
    let angles: Vec<f64> = (0..POSITIONS).map(|i| TAU * i as f64 / POSITIONS as f64).collect();
    // Those of the kernel itself, which may differ from others in the last digit.
    let (sin, cos): (Vec<f64>, Vec<f64>) = angles.iter().map(|angle| sin_cos(*angle)).unzip();
    let mut out = CouplerPoints::with_room(POSITIONS);
    out.fill(&kernel, &cos, &sin);
    for (i, angle) in angles.iter().enumerate() {
        let p = linkage.position(*angle).joints().expect("the crank turns fully").coupler_point;
        assert_eq!((out.x[i], out.y[i]), (p.re, p.im), "lanes and scalar agree to the bit");
        let [x, y] = textbook(&linkage, *angle);
        assert!((x - p.re).hypot(y - p.im) < 1e-12 * 10.0, "the textbook agrees at {angle}: {x} {y} {p}");
    }

    let mut group = c.benchmark_group(format!("coupler position ({})", vector_unit()));
    group.throughput(Throughput::Elements(POSITIONS as u64));
    lanes_row(&mut group, "bound: one sqrt and one div", RootAndDivision, [&cos, &sin]);
    lanes_row(&mut group, "lanes", kernel, [&cos, &sin]);
    group.bench_function("scalar, cos and sin tabulated", |b| {
        b.iter(|| {
            let mut sum = 0.0;
            for (c, s) in cos.iter().zip(&sin) {
                let at = kernel.at(black_box(*c), black_box(*s));
                sum += if at.gap >= 0.0 { at.coupler_point[0] + at.coupler_point[1] } else { 0.0 };
            }
            black_box(sum)
        });
    });
    group.bench_function("scalar, from the angle", |b| {
        b.iter(|| {
            let mut sum = 0.0;
            for angle in &angles {
                if let Some(joints) = linkage.position(black_box(*angle)).joints() {
                    sum += joints.coupler_point.re;
                }
            }
            black_box(sum)
        });
    });
    group.bench_function("textbook, by angles", |b| {
        b.iter(|| {
            let mut sum = 0.0;
            for angle in &angles {
                sum += textbook(black_box(&linkage), black_box(*angle))[0];
            }
            black_box(sum)
        });
    });
    group.finish();
}

/// The bound of a slider-crank takes the square root that every position needs, and does nothing else.
#[derive(Clone, Copy)]
struct Root;

/// The bound of the other kinds takes the square root and the division that every position needs, and does nothing else.
#[derive(Clone, Copy)]
struct RootAndDivision;

impl LaneKernel for Root {
    #[inline(always)]
    fn at<L: Lane>(&self, cos: L, sin: L) -> LanePosition<L> {
        let root = (cos + L::splat(2.0)).sqrt();
        LanePosition { crank_pin: [cos, sin], follower_pin: [cos, sin], coupler_point: [root, sin], gap: sin }
    }
}

impl LaneKernel for RootAndDivision {
    #[inline(always)]
    fn at<L: Lane>(&self, cos: L, sin: L) -> LanePosition<L> {
        let at = Root.at(cos, sin);
        LanePosition { coupler_point: [at.coupler_point[0], (cos + L::splat(2.0)).recip()], ..at }
    }
}

/// Times a kernel, or a bound with the same loads and stores, in lanes at tabulated cosines and sines.
fn lanes_row(group: &mut Group<'_>, name: &str, kernel: impl LaneKernel + Copy, [cos, sin]: [&[f64]; 2]) {
    let mut points = CouplerPoints::with_room(POSITIONS);
    group.bench_function(name, |b| {
        b.iter(|| {
            points.fill(black_box(&kernel), black_box(cos), black_box(sin));
            black_box(&mut points);
        });
    });
}

/// The kernels of the linkages with a slider: coupler points in lanes beside the bound, and all joints from the angle,
/// eight at a time and alone.
fn sliders(c: &mut Criterion) {
    let (zero, z) = (Complex::new(0.0, 0.0), Complex::new(5.0, 1.0));
    let line = (Complex::new(0.0, 1.0), 0.3);
    let slider = SliderCrank::from_parts(zero, [2.0, 5.0], line, z, AssemblyMode::Plus).expect("lengths");
    let pivots = [zero, Complex::new(4.0, 1.0)];
    let inverted = InvertedSliderCrank::from_parts(pivots, 2.0, 0.5, z, AssemblyMode::Plus).expect("lengths");
    let mut group = c.benchmark_group(format!("slider position ({})", vector_unit()));
    group.throughput(Throughput::Elements(POSITIONS as u64));
    let angles: Vec<f64> = (0..POSITIONS).map(|i| TAU * i as f64 / POSITIONS as f64).collect();
    let (sin, cos): (Vec<f64>, Vec<f64>) = angles.iter().map(|angle| sin_cos(*angle)).unzip();
    lanes_row(&mut group, "bound: one sqrt", Root, [&cos, &sin]);
    slider_rows(&mut group, "slider-crank", &slider, &angles);
    lanes_row(&mut group, "bound: one sqrt and one div", RootAndDivision, [&cos, &sin]);
    slider_rows(&mut group, "inverted slider-crank", &inverted, &angles);
    group.finish();
}

fn slider_rows<L: SliderLinkage>(group: &mut Group<'_>, name: &str, linkage: &L, angles: &[f64]) {
    let mut columns = [(); 3].map(|()| vec![[0.0; 2]; POSITIONS]);
    let fill = |[c, d, p]: &mut [Vec<[f64; 2]>; 3], angles: &[f64]| {
        linkage.positions(angles, JointColumns { crank_pin: c, follower_pin: d, coupler_point: p });
    };
    fill(&mut columns, angles);
    let (sin, cos): (Vec<f64>, Vec<f64>) = angles.iter().map(|angle| sin_cos(*angle)).unzip();
    let (kernel, mut points) = (linkage.kernel(), CouplerPoints::with_room(POSITIONS));
    points.fill(&kernel, &cos, &sin);
    for (i, angle) in angles.iter().enumerate() {
        let at = linkage.position(*angle).joints().expect("the crank turns fully");
        let lanes = columns.each_ref().map(|column| column[i]);
        let alone = [at.crank_pin, at.slider_pin, at.coupler_point].map(xy);
        assert_eq!(lanes, alone, "lanes and scalar agree to the bit");
        assert_eq!([points.x[i], points.y[i]], alone[2], "tabulated sines give the same digits");
    }
    lanes_row(group, &format!("{name}, lanes"), kernel, [&cos, &sin]);
    group.bench_function(format!("{name}, lanes, from the angle"), |b| {
        b.iter(|| {
            fill(black_box(&mut columns), black_box(angles));
        });
    });
    group.bench_function(format!("{name}, scalar, from the angle"), |b| {
        b.iter(|| {
            let mut sum = 0.0;
            for angle in angles {
                if let Some(joints) = linkage.position(black_box(*angle)).joints() {
                    sum += joints.coupler_point.re;
                }
            }
            black_box(sum)
        });
    });
}

criterion_group!(benches, positions, sliders);
criterion_main!(benches);
