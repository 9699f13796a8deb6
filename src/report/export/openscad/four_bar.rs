//! The script of a four-bar.

use super::{PLATE, Script};
use crate::mechanism::FourBar;

/// Returns the parameters and the body for a four-bar.
pub(super) fn script(linkage: &FourBar) -> Script {
    let (p, offset) = (linkage.natural_coordinates(), linkage.coupler_offset());
    Script {
        t1: "1: D lies left of the line from C to B; -1: right",
        numbers: vec![
            ("Ax", p.crank_pivot[0], "A, the fixed pivot of the crank"),
            ("Ay", p.crank_pivot[1], ""),
            ("Bx", p.follower_pivot[0], "B, the fixed pivot of the follower"),
            ("By", p.follower_pivot[1], ""),
            ("a", p.crank, "|AC|, the crank"),
            ("b", p.coupler, "|CD|, the coupler"),
            ("c", p.follower, "|BD|, the follower"),
            ("Px", offset.re, "P along C -> D, from C"),
            ("Py", offset.im, "P across C -> D, left positive"),
        ],
        body: [POINTS, PLATE, REST].concat(),
    }
}

/// The points of the plates.
const POINTS: &str = r#"
A = [Ax, Ay];
B = [Bx, By];
g = norm(B - A);
P = [Px, Py];
"#;

/// The plates and the assembly; equations 10 to 18 of Romero (2016) give D and P.
const REST: &str = r#"module ground() plate([[0, 0, @hole:ground:A@], [g, 0, @hole:ground:B@]], @r:ground@@t:ground@);
module crank() plate([[0, 0, @hole:crank:A@], [a, 0, @hole:crank:C@]], @r:crank@@t:crank@);
module coupler() plate([[0, 0, @hole:coupler:C@], [b, 0, @hole:coupler:D@], [P.x, P.y, @hole:coupler:P@]], @r:coupler@@t:coupler@);
module follower() plate([[0, 0, @hole:follower:B@], [c, 0, @hole:follower:D@]], @r:follower@@t:follower@);

// Where the joints are: C on the crank, D = C + V (u + i t1 sqrt k) with V = B - C.
C = A + a * [cos(crank_deg), sin(crank_deg)];
V = B - C;
s2 = V * V;
u = (1 + (b * b - c * c) / s2) / 2;
k = b * b / s2 - u * u;
assert(view == "plates" || k > -1e-9, "the links cannot be joined at this crank angle");
q = t1 * sqrt(max(0, k));
D = C + [V.x * u - V.y * q, V.y * u + V.x * q];

// Puts a plate's first hole on one joint and its x axis towards another, in a layer.
module place(from, to, layer)
    translate([from.x, from.y, layer * @pitch@])
        rotate(atan2(to.y - from.y, to.x - from.x)) children();

if (view == "assembly") {
    color("silver") place(A, B, 0) ground();
    color("tomato") place(A, C, 1) crank();
    color("steelblue") place(C, D, 2) coupler();
    color("seagreen") place(B, D, 3) follower();
} else {
    above = 2 * r_ground + 2 * r_crank + 2 * gap;
    bottom = @r:coupler@ - min(0, P.y);
    translate([r_ground, r_ground, 0]) ground();
    translate([r_crank, 2 * r_ground + gap + r_crank, 0]) crank();
    translate([@r:coupler@ - min(0, P.x), above + bottom, 0]) coupler();
    translate([@r:follower@, above + bottom + max(0, P.y) + @both@ + gap, 0]) follower();
}
"#;
