//! Lengths snapped to a stock: exact, judged under the problem as it was, and no worse than trying everything.

use crate::common::{load, literature, root, run_on};
use linkwright::problem::Problem;
use linkwright::search::Budget;
use linkwright::search::rank::compare;
use linkwright::snap::{Fixed, Length, Request, SnapError, Stock, own_curve, record, snap};
use std::sync::atomic::AtomicBool;

#[test]
fn look() {
    for (name, step) in [("e5", 5.0), ("k18", 0.5), ("l10", 0.5), ("e5-free", 5.0), ("shape-heart", 5.0), ("v6", 5.0), ("a6", 5.0)] {
        let file = literature(name, &[("solve.candidates", "1"), ("solve.evaluations", "20000")]);
        let r = run_on(2, file);
        let problem = Problem::new(r.problem.resolved.clone()).unwrap();
        let budget = Budget::new(Box::leak(Box::new(AtomicBool::new(false))), None);
        let c = &r.candidates[0];
        let size = problem.task().size();
        let step = if step > 0.0 { size / 40.0 } else { step };
        let request = Request { stock: Stock::grid(step).unwrap(), lengths: Length::ALL.to_vec(), fixed: Fixed::default(), wanted: 3 };
        let t = std::time::Instant::now();
        let s = snap(&problem, c, &request, &budget);
        let el = t.elapsed();
        match s {
            Ok(s) => {
                let rec = record(&problem, "x", None, None, &request, &s).unwrap();
                println!("{name} step {step} rms {:.4e} acc {} -> {:?} acc {} nearest {:?} fits {} {:?} verify {:?}\n {} \n {}", c.error.rms, c.accepted, s.candidates.iter().map(|c| c.error.rms).collect::<Vec<_>>(), s.candidates[0].accepted, s.nearest.as_ref().map(|c| (c.error.rms, c.accepted)), s.fits, el, linkwright::verify::verify(&rec).unwrap(), c.linkage, s.candidates[0].linkage);
            }
            Err(e) => println!("{name} {e} {el:?}"),
        }
    }
}
