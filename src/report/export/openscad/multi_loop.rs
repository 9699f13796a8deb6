//! The scripts of six-bars and eight-bars: the dyads one after the other, each link in the frame of its line.

use super::{PLATE, Parameter, Script};
use crate::mechanism::MultiLoop;
use crate::mechanism::dyad_chain::kinds::{CRANK, GROUND, MAX_BODIES};
use crate::mechanism::multi_loop::Body;
use crate::mechanism::plates::{Link, Parts};

/// The places on a body, in words.
const ON: [&str; MAX_BODIES] = [
    "on the ground, from the origin",
    "on the crank, along A -> C from A",
    "on the coupler, along C -> D from C",
    "on the follower, along B -> D from B",
    "on link5, along X2 -> F2 from X2",
    "on link6, along Y2 -> F2 from Y2",
    "on link7, along X3 -> F3 from X3",
    "on link8, along Y3 -> F3 from Y3",
];
/// Of each further dyad: the coordinates of X and Y, the lengths of its links, and its sign.
const OF_DYAD: [[&str; 7]; 2] =
    [["X2x", "X2y", "Y2x", "Y2y", "X2F2", "Y2F2", "t2"], ["X3x", "X3y", "Y3x", "Y3y", "X3F3", "Y3F3", "t3"]];
/// The colours of the plates in the assembly.
const COLOURS: [&str; MAX_BODIES] =
    ["silver", "tomato", "steelblue", "seagreen", "orange", "mediumpurple", "gold", "teal"];

/// Returns the parameters and the body for a linkage of several loops.
pub(super) fn script(linkage: &MultiLoop, parts: &Parts) -> Script {
    let (dyads, kind) = (linkage.dyads(), linkage.chain_kind());
    let (a, b, p) = (linkage.crank_pivot(), linkage.follower_pivot(), linkage.coupler_point());
    let mut numbers: Vec<Parameter> = vec![
        ("Ax", a.re, "A, the fixed pivot of the crank"),
        ("Ay", a.im, ""),
        ("Bx", b.re, "B, the fixed pivot of the follower"),
        ("By", b.im, ""),
        ("a", linkage.crank(), "|AC|, the crank"),
        ("b", dyads[0].lengths[0], "|CD|, the coupler"),
        ("c", dyads[0].lengths[1], "|BD|, the follower"),
    ];
    for (j, (dyad, keys)) in dyads.iter().skip(1).zip(OF_DYAD).enumerate() {
        let on = kind.anchors(j + 1);
        for end in 0..2 {
            numbers.push((keys[2 * end], dyad.ends[end].re, ON[on[end]]));
            numbers.push((keys[2 * end + 1], dyad.ends[end].im, "across it, left positive"));
        }
        numbers.push((keys[4], dyad.lengths[0], "the one link of this dyad"));
        numbers.push((keys[5], dyad.lengths[1], "the other"));
        numbers.push((
            keys[6],
            dyad.side.sign(),
            "1: its joint lies left of the line from X to Y; -1: right",
        ));
    }
    numbers.push(("Px", p.re, ON[kind.traced()]));
    numbers.push(("Py", p.im, "across it, left positive"));
    Script {
        t1: "1: D lies left of the line from C to B; -1: right",
        numbers,
        body: ["\n", PLATE, FUNCTIONS, &frames(linkage), &plates(linkage, parts), LAYOUT].concat(),
    }
}

/// Returns the lines that compute the joints and the frame of every link.
fn frames(linkage: &MultiLoop) -> String {
    let name = |body: usize| Link::OF_BODIES[body].name();
    let mut out = String::new();
    for j in 1..linkage.dyad_count() {
        let (on, [x_x, x_y, y_x, y_y, l1, l2, t]) = (linkage.chain_kind().anchors(j), OF_DYAD[j - 1]);
        let n = j + 1;
        out.push_str(&format!(
            "X{n} = at({}_frame, [{x_x}, {x_y}]);\nY{n} = at({}_frame, [{y_x}, {y_y}]);\n\
             F{n} = meeting(X{n}, Y{n}, {l1}, {l2}, {t});\n{}_frame = line(X{n}, F{n});\n{}_frame = line(Y{n}, F{n});\n",
            name(on[0]),
            name(on[1]),
            name(2 * n),
            name(2 * n + 1),
        ));
    }
    out
}

/// Returns the lines with the holes of every plate, its module, and the assembly of all.
fn plates(linkage: &MultiLoop, parts: &Parts) -> String {
    let mut out = String::from("\n// Holes are x, y and their diameter.\n");
    for Body { body, joints } in linkage.links() {
        let hole = |(i, (joint, _)): (usize, &(&str, crate::mechanism::Complex))| {
            let place = match (body, i) {
                (GROUND, _) => format!("own(ground_line, {joint})"),
                (_, 0) => "[0, 0]".to_owned(),
                (CRANK, _) if *joint == "C" => "[a, 0]".to_owned(),
                (2 | 3, 1) => format!("[{}, 0]", ["b", "c"][body - 2]),
                (_, 1) if body != CRANK => format!("[{}, 0]", OF_DYAD[body / 2 - 2][4 + body % 2]),
                _ => format!("[{joint}x, {joint}y]"),
            };
            format!("hole_at({place}, @hole:{}:{joint}@)", Link::OF_BODIES[body].name())
        };
        let holes: Vec<String> = joints.iter().enumerate().map(hole).collect();
        let name = Link::OF_BODIES[body].name();
        out.push_str(&format!("{name}_holes = [{}];\n", holes.join(", ")));
        out.push_str(&format!("module {name}() plate({name}_holes, @r:{name}@@t:{name}@);\n"));
    }
    out.push_str("\nmodule assembly() {\n");
    for (layer, link) in parts.links().into_iter().enumerate() {
        let frame =
            if link == Link::Ground { "ground_line".to_owned() } else { format!("{}_frame", link.name()) };
        out.push_str(&format!(
            "    color(\"{}\") place({frame}, {layer}) {}();\n",
            COLOURS[link.place()],
            link.name()
        ));
    }
    out.push_str("}\nmodule layout() {\n");
    let mut below = String::from("0");
    for link in parts.links() {
        let name = link.name();
        out.push_str(&format!("    laid({name}_holes, @r:{name}@, {below}) {name}();\n"));
        below.push_str(&format!(" + height({name}_holes, @r:{name}@)"));
    }
    out.push_str("}\n");
    out
}

/// The functions, the ground and the first dyad; F = X + V (x + i t h) as of every dyad.
const FUNCTIONS: &str = r#"
function hole_at(p, diameter) = [p.x, p.y, diameter];

// A frame is a point and a direction; a place z in it is point + direction z, as complex numbers.
function product(u, z) = [u.x * z.x - u.y * z.y, u.y * z.x + u.x * z.y];
function line(from, to) = [from, (to - from) / norm(to - from)];
function at(frame, z) = frame[0] + product(frame[1], z);
function own(frame, p) = product([frame[1].x, -frame[1].y], p - frame[0]);

// The joint of a dyad: at l1 from x and at l2 from y, on the left of the line from x to y for t = 1.
function share(s2, l1, l2) = (1 + (l1 * l1 - l2 * l2) / s2) / 2;
function height2(s2, l1, l2) = l1 * l1 / s2 - pow(share(s2, l1, l2), 2);
function joined(k) = assert(view == "plates" || k > -1e-9, "the links cannot be joined at this crank angle") k;
function meeting(x, y, l1, l2, t) = let (v = y - x, s2 = v * v)
    x + product(v, [share(s2, l1, l2), t * sqrt(max(0, joined(height2(s2, l1, l2))))]);

A = [Ax, Ay];
B = [Bx, By];
C = A + a * [cos(crank_deg), sin(crank_deg)];
ground_frame = [[0, 0], [1, 0]];
ground_line = line(A, B);
crank_frame = line(A, C);
D = meeting(C, B, b, c, t1);
coupler_frame = line(C, D);
follower_frame = line(B, D);
"#;

/// The layout of the plates, one above another.
const LAYOUT: &str = r#"
function low(points) = [min([for (p = points) p.x]), min([for (p = points) p.y])];
function high(points) = [max([for (p = points) p.x]), max([for (p = points) p.y])];
function height(points, r) = high(points).y - low(points).y + 2 * r + gap;
module laid(points, r, y) translate([r - low(points).x, y + r - low(points).y, 0]) children();
// Puts a plate's origin on that of a frame and its x axis along its direction, in a layer.
module place(frame, layer)
    translate([frame[0].x, frame[0].y, layer * @pitch@])
        rotate(atan2(frame[1].y, frame[1].x)) children();

if (view == "assembly") {
    assembly();
} else {
    layout();
}
"#;
