//! The bodies and pairs of a chain: every stage but an attached point is a group of two bodies.

use super::{Chain, Line as StepLine, Step};
use crate::mechanism::Complex;
use crate::mechanism::structure::{Body, Group, Line, Pair, Structure};

impl Chain {
    /// Returns the bodies and pairs of the chain. A link has the name of its joints, as [`moving_links`] has it; the block of a
    /// slider or a guide that makes N is `block-N`.
    ///
    /// [`moving_links`]: crate::mechanism::Mechanism::moving_links
    pub(in crate::mechanism) fn parts(&self) -> Structure {
        let fixed = self.links[0].iter().map(|id| id.0).zip(self.places[0].iter().copied());
        let mut structure = Structure {
            bodies: vec![Body::ground(fixed), self.link(1)],
            crank_pivot: self.crank_pivot,
            groups: Vec::new(),
            output: None,
        };
        let mut links = 2;
        // For each link of the chain its body.
        let mut body_of = vec![0, 1];
        for (stage, step) in self.steps.iter().enumerate() {
            let (made, first) = (self.pivots.len() + 1 + stage, structure.bodies.len());
            let carrier = |structure: &Structure, joint: usize| structure.carriers(joint).next().unwrap_or(0);
            let [one, two] = [first, first + 1];
            match *step {
                Step::Point { .. } => continue,
                Step::Dyad { p, q, .. } => {
                    let on = [p, q].map(|joint| carrier(&structure, joint));
                    structure.bodies.extend([self.link(links), self.link(links + 1)]);
                    body_of.extend([one, two]);
                    links += 2;
                    let pairs =
                        [Pair::pin(p, [on[0], one]), Pair::pin(q, [on[1], two]), Pair::pin(made, [one, two])];
                    structure.groups.push(Group { bodies: [one, two], pairs });
                }
                Step::Slider { p, line, .. } => {
                    let on = carrier(&structure, p);
                    let (rail, line) = self.rail(line, &body_of);
                    structure.bodies.extend([self.link(links), self.block(made, line, made)]);
                    body_of.push(one);
                    links += 1;
                    let pairs = [
                        Pair::pin(p, [on, one]),
                        Pair::pin(made, [one, two]),
                        Pair::slide(made, [rail, two]),
                    ];
                    structure.groups.push(Group { bodies: [one, two], pairs });
                }
                Step::Guide { p, q, w, .. } => {
                    let on = [p, q].map(|joint| carrier(&structure, joint));
                    let line = Line::OnBody { body: one, turn: w.conj() / w.norm() };
                    structure.bodies.extend([self.link(links), self.block(made, line, q)]);
                    body_of.push(one);
                    links += 1;
                    let pairs =
                        [Pair::pin(p, [on[0], one]), Pair::pin(q, [on[1], two]), Pair::slide(q, [one, two])];
                    structure.groups.push(Group { bodies: [one, two], pairs });
                }
            }
        }
        structure
    }

    /// Returns a link as a body, with the places of its joints along and across the line from the first to the second.
    fn link(&self, link: usize) -> Body {
        let (joints, places) = (&self.links[link], &self.places[link]);
        let names: Vec<&str> = joints.iter().map(|id| self.names[id.0].as_str()).collect();
        let turn = self.own_direction(link).conj();
        let places: Vec<(usize, Complex)> =
            joints.iter().zip(places).map(|(id, place)| (id.0, place * turn)).collect();
        Body::link(&names.join("-"), &places)
    }

    fn block(&self, made: usize, line: Line, on: usize) -> Body {
        Body::block(&format!("block-{}", self.names[made]), line, &[(on, Complex::new(0.0, 0.0))])
    }

    /// Returns the unit direction from the first joint of a link to its second in the frame of its places; 1 of the ground.
    fn own_direction(&self, link: usize) -> Complex {
        match self.places[link].as_slice() {
            [_, second, ..] if link > 0 => second / second.norm(),
            _ => Complex::new(1.0, 0.0),
        }
    }

    /// Returns the body on which the block of a slider slides, and its line there.
    fn rail(&self, line: StepLine, body_of: &[usize]) -> (usize, Line) {
        let (p, q) = match line {
            StepLine::Fixed { direction, .. } => return (0, Line::Fixed(direction)),
            StepLine::OnLink { p, q, .. } => (p, q),
        };
        let place = |link: usize, joint: usize| {
            let at = self.links[link].iter().position(|id| id.0 == joint)?;
            Some(self.places[link][at])
        };
        // The assembly refuses a line on no link, so that there is one.
        let found = (0..body_of.len()).find_map(|link| {
            let along = place(link, q)? - place(link, p)?;
            Some((link, along / along.norm() * self.own_direction(link).conj()))
        });
        let (link, turn) = found.unwrap_or((0, Complex::new(1.0, 0.0)));
        match body_of.get(link) {
            Some(&body) if body > 0 => (body, Line::OnBody { body, turn }),
            _ => (0, Line::Fixed(turn)),
        }
    }
}
