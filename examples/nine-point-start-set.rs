fn main() {
    use linkwright::exact::monodromy::*;
    use linkwright::solve::streams::{stream, unit};
    for seed in 1..4 {
        let mut s = stream(seed, 0);
        let now = std::time::Instant::now();
        let o = orbit(&mut || unit(&mut s), &Limits::default(), &std::sync::atomic::AtomicBool::new(false));
        println!("{} classes, {} loops, {} idle, {:?}", o.solutions.len(), o.loops, o.idle, now.elapsed());
    }
}
