//! The length program: against brute force, against bounds, and on random T-meshes.

mod drawing;

use drawing::{draw, polygons, quad};
use quadrel::domain::Boundary;
use quadrel::layout::bidirected_flow::{BidirectedFlow, End, Row, Variable};
use quadrel::layout::lengths::LengthProgram;
use quadrel::layout::{conform, BlockLayout, BorderNode, LengthTargets, Targets};
use quadrel::numerics::Point;

/// A small generator with a fixed seed (xorshift), uniform in [0, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() * n as f64) as usize
    }
}

/// A random bidirected program of few variables, each of both ends at random.
fn program(random: &mut Random) -> (usize, Vec<Variable>) {
    let equations = 1 + random.below(3);
    let variables = (0..3 + random.below(3))
        .map(|_| {
            let mut end = || match random.below(equations + 1) {
                e if e == equations => End::FREE,
                e => End { equation: e as u32, sign: if random.next() < 0.5 { 1 } else { -1 } },
            };
            let ends = [end(), end()];
            let weight = [1.0, 1.0, 2.0][random.below(3)];
            Variable { target: 4.0 * random.next(), weight, lower: random.below(2) as i32, ends }
        })
        .collect();
    (equations, variables)
}

/// Least cost over all values up to `top`, if any is feasible.
fn brute_force(equations: usize, variables: &[Variable], rows: &[Row], top: i32) -> Option<f64> {
    let mut best: Option<f64> = None;
    let mut n: Vec<i32> = variables.iter().map(|v| v.lower).collect();
    loop {
        let mut sums = vec![0; equations];
        for (v, &x) in variables.iter().zip(&n) {
            for end in v.ends {
                if let Some(s) = sums.get_mut(end.equation as usize) {
                    *s += end.sign * x;
                }
            }
        }
        let rows_hold =
            rows.iter().all(|r| r.variables.iter().map(|&a| n[a as usize]).sum::<i32>() >= r.at_least);
        if rows_hold && sums.iter().all(|&s| s == 0) {
            let cost: f64 =
                variables.iter().zip(&n).map(|(v, &x)| v.weight * (x as f64 - v.target).abs()).sum();
            best = Some(best.map_or(cost, |b| b.min(cost)));
        }
        let Some(i) = (0..n.len()).find(|&i| n[i] < top) else { return best };
        n[i] += 1;
        (0..i).for_each(|k| n[k] = variables[k].lower);
    }
}

#[test]
fn small_programs_are_solved_as_by_brute_force() {
    let mut random = Random(7);
    let (mut feasible, mut optimal) = (0, 0);
    for case in 0..600 {
        let (equations, variables) = program(&mut random);
        let rows: Vec<Row> = (0..random.below(2))
            .map(|_| Row { variables: vec![0, 1], at_least: 2 + random.below(4) as i32 })
            .collect();
        let best = brute_force(equations, &variables, &rows, 9);
        let mut flow = BidirectedFlow::new(equations, variables.clone());
        rows.iter().for_each(|r| flow.add_row(r.clone()));
        let solved = flow.solve();
        flow.polish();
        if solved.is_ok() {
            assert!(flow.is_feasible(), "case {case}");
        }
        match best {
            // The bound of the brute force may hide solutions, never the solver's.
            None => assert!(solved.is_err() || flow.values().iter().any(|&n| n > 9), "case {case}"),
            Some(best) => {
                feasible += 1;
                assert!(solved.is_ok(), "case {case}: {variables:?} {rows:?}");
                assert!(flow.cost() > best - 1e-9);
                optimal += (flow.cost() < best + 0.01) as usize;
            }
        }
    }
    assert!(feasible > 250, "{feasible}");
    assert!(optimal * 100 >= feasible * 95, "{optimal} of {feasible}");
}

#[test]
fn an_odd_triangle_is_refused_and_an_even_one_solved() {
    // x + y = 3, y + z = 2, z + x = 2 has the solution (1.5, 1.5, 0.5) only.
    let end = |e: u32, sign| End { equation: e, sign };
    let spoke = |a, b| Variable { target: 1.0, weight: 1.0, lower: 0, ends: [end(a, -1), end(b, -1)] };
    let fixed = |e, n: i32| {
        // Bounded from both sides: n = lower + (something ≤ 0 that only this equation has).
        Variable { target: n as f64, weight: 1e3, lower: n, ends: [end(e, 1), End::FREE] }
    };
    let variables = |n| vec![spoke(0, 1), spoke(1, 2), spoke(2, 0), fixed(0, n), fixed(1, 2), fixed(2, 2)];
    let mut even = BidirectedFlow::new(3, variables(2));
    assert!(even.solve().is_ok());
    assert_eq!(even.values()[..3], [1, 1, 1]);
    let mut odd = BidirectedFlow::new(3, variables(3));
    assert!(odd.solve().is_ok());
    assert!(odd.is_feasible());
    // One side has to give way by one.
    assert_eq!(odd.values()[3..].iter().sum::<i32>(), 8);
    // Without free ends the parity cannot change.
    let closed: Vec<Variable> = vec![
        Variable { ends: [end(0, 1), end(0, 1)], ..spoke(0, 0) },
        Variable { target: 1.0, weight: 1.0, lower: 1, ends: [end(0, -1), end(1, 1)] },
        Variable { target: 3.0, weight: 1.0, lower: 3, ends: [end(1, -1), end(1, -1)] },
    ];
    let mut flow = BidirectedFlow::new(2, closed);
    assert!(flow.solve().is_ok());
    assert!(flow.is_feasible());
}

#[test]
fn a_contradiction_is_found_and_located() {
    // a = a + b with b ≥ 1 in equation 0; equation 1 has no part in it.
    let end = |e: u32, sign| End { equation: e, sign };
    let variables = vec![
        Variable { target: 2.0, weight: 1.0, lower: 0, ends: [end(0, 1), end(0, -1)] },
        Variable { target: 1.0, weight: 1.0, lower: 1, ends: [end(0, 1), End::FREE] },
        Variable { target: 1.0, weight: 1.0, lower: 1, ends: [end(1, 1), End::FREE] },
        Variable { target: 3.0, weight: 1.0, lower: 1, ends: [end(1, -1), End::FREE] },
    ];
    let obstruction = BidirectedFlow::new(2, variables).solve().unwrap_err();
    assert_eq!(obstruction.equations, [0]);
}

/// A square cut at random: each cut joins opposite sides of a region, so its ends are T-junctions.
fn random_t_mesh(cuts: usize, seed: u64) -> (Boundary, BlockLayout) {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let boundary = polygons(&[corners.iter().map(|&(x, y)| Point::new(x, y)).collect()]);
    let mut layout = draw(&boundary, &corners, &[quad([0, 1, 2, 3])], &[]);
    let mut random = Random(seed);
    for _ in 0..cuts {
        // Of a few regions the largest, so that sizes stay comparable.
        let area = |r: &u32| {
            let p = layout.polygon(*r);
            (0..p.len())
                .map(|i| p[i].x * p[(i + 1) % p.len()].y - p[i].y * p[(i + 1) % p.len()].x)
                .sum::<f64>()
        };
        let candidates: Vec<u32> = (0..6).map(|_| random.below(layout.regions.len()) as u32).collect();
        let r = candidates.into_iter().max_by(|a, b| area(a).total_cmp(&area(b))).unwrap();
        let side = random.below(2);
        let share = 0.2 + 0.6 * random.next();
        // Where the cut meets the side: the coordinate along it, by its end points.
        let ends = [side, (side + 1) % 4].map(|s| layout.start(layout.regions[r as usize].sides[s][0]));
        let [a, b] = ends.map(|v| layout.nodes[v as usize].point);
        let x = a + (b - a) * share;
        let along = |p: Point| (p - x).dot(&(b - a)) / (b - a).norm_squared();
        let crossing = |s: usize| {
            layout.regions[r as usize].sides[s].iter().enumerate().find_map(|(i, arc)| {
                let nodes = layout.arcs[arc.arc as usize].nodes;
                let [p, q] = nodes.map(|v| along(layout.nodes[v as usize].point));
                let t = p / (p - q);
                (t > 0.02 && t < 0.98).then_some((arc.arc, t, BorderNode { side: s, index: i + 1 }))
            })
        };
        // Now and then a crossing is too close to a node: no cut then.
        let (Some(one), Some(two)) = (crossing(side), crossing(side + 2)) else { continue };
        let places = [one, two].map(|(arc, t, place)| {
            layout.split_arc(arc, t, &|_| 1.0, &boundary);
            place
        });
        layout.cut(r, places[0], places[1]);
    }
    (boundary, layout)
}

#[test]
fn random_t_meshes_are_solved_and_conform() {
    for seed in 1..=12 {
        let (boundary, layout) = random_t_mesh(6 * seed as usize, seed);
        layout.check(&boundary).unwrap();
        for h in [0.02, 0.1, 0.4] {
            let size = move |p: Point| if h < 0.05 { h } else { h * (0.3 + p.x) };
            let targets = Targets::new(&size, &[5, 1, 1, 9]);
            let result = conform(&layout, &boundary, &targets).unwrap();
            result.layout.check(&boundary).unwrap();
            assert_eq!((result.fallback, result.relaxed), (0, 0), "always feasible");
            // Lengths that match the targets within one on average: T-meshes of a square have no
            // obstruction, only rounding, where the mesh is fine.
            if h < 0.05 {
                let wanted = LengthTargets::new(&layout, &boundary, &targets).wanted;
                assert!(result.cost <= 1.2 * wanted.len() as f64, "seed {seed}: {}", result.cost);
            }
        }
    }
}

#[test]
fn thousands_of_arcs_are_solved_to_a_local_optimum() {
    let (boundary, layout) = random_t_mesh(3_600, 99);
    assert!(layout.arcs.len() > 10_000);
    let size = |p: Point| 0.004 + 0.02 * p.y;
    let targets = Targets::new(&size, &[]);
    let wanted = LengthTargets::new(&layout, &boundary, &targets);
    let mut program = LengthProgram::new(&layout, &boundary, &wanted);
    let start = std::time::Instant::now();
    program.solve().unwrap();
    println!("{} arcs, cost {}, {:?}", layout.arcs.len(), program.flow.cost(), start.elapsed());
    assert!(program.flow.is_feasible());
    let cost = program.flow.cost();
    // Again from the solution: nothing left to gain.
    program.solve().unwrap();
    assert!(program.flow.cost() > 0.99 * cost);
}

/// Programs side by side are a large one, which is solved in another way.
#[test]
fn a_large_program_costs_what_its_parts_cost() {
    for (with_rows, margin) in [(false, 1.001), (true, 1.02)] {
        let mut random = Random(11);
        let mut apart = 0.0;
        let (mut equations, mut variables, mut rows) = (0, Vec::new(), Vec::new());
        for seed in 1..=16 {
            let (boundary, layout) = random_t_mesh(200, seed);
            let size = |_| 0.09;
            let wanted = LengthTargets::new(&layout, &boundary, &Targets::new(&size, &[]));
            let LengthProgram { mut flow, region_of, .. } = LengthProgram::new(&layout, &boundary, &wanted);
            let part = flow.variables().to_vec();
            let first = variables.len() as u32;
            for _ in 0..if with_rows { 25 } else { 0 } {
                let own =
                    vec![random.below(layout.arcs.len()) as u32, random.below(layout.arcs.len()) as u32];
                flow.add_row(Row { variables: own.clone(), at_least: 2 });
                rows.push(Row { variables: own.iter().map(|a| a + first).collect(), at_least: 2 });
            }
            assert!(flow.solve().is_ok());
            apart += flow.cost();
            variables.extend(part.into_iter().map(|variable| {
                let ends = variable.ends.map(|end| match end {
                    End::FREE => End::FREE,
                    end => End { equation: end.equation + equations as u32, ..end },
                });
                Variable { ends, ..variable }
            }));
            equations += region_of.len();
        }
        assert!(equations > 5000, "{equations} equations make no large program");
        let mut flow = BidirectedFlow::new(equations, variables);
        rows.into_iter().for_each(|row| flow.add_row(row));
        assert!(flow.solve().is_ok());
        assert!(flow.is_feasible());
        assert!(flow.cost() < margin * apart, "{} and apart {apart}", flow.cost());
    }
}
