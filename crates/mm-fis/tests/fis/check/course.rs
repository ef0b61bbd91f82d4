//! Turns and jumps of the output, and its reach.

use super::{PLANE, SOUND, kinds, near, one, report, system, with};
use mm_fis::check::{Course, FindingKind as Kind, along};

#[test]
fn turns_and_jumps_of_one_input() {
    let turn = report(&with(SOUND, "3, 3 (1)", "3, 1 (1)").replace("MF3='many':'trimf',[3 4 5]\n", ""));
    let runs = &one(&turn, Kind::NotMonotone).runs;
    assert_eq!(runs.len(), 2, "up and down: {runs:#?}");
    assert_eq!((runs[0].from, runs[0].to, runs[1].to), (0.0, 2.0, 4.0), "at the peak of `mid`");
    near(runs[0].to_value, 2.0, 1e-12, "centroid of `some`");
    assert!(runs[0].rises() && !runs[1].rises(), "which is which");
    // A term with a vertical side: `mid` ends at 3 where it still holds by half.
    let text = with(&with(SOUND, "'trimf',[0 2 4]", "'trapmf',[0 2 3 3]"), "[2 4 4]", "[3 4 4]");
    let report = report(&text);
    let [jump] = one(&report, Kind::Jump).jumps.as_slice() else { panic!("one jump") };
    assert_eq!(jump.inputs, [3.0], "where `mid` ends");
    near(jump.left, 2.0, 1e-9, "only `mid` up to there");
    near(jump.value, 2.0, 1e-9, "and there");
    near(jump.right, 4.0, 1e-9, "only `high` from there");
    let found = one(&report, Kind::Jump).message.clone();
    assert_eq!(found, "output `y` jumps at `x` = 3 (from 2 through 2 to 4)");
}

#[test]
fn turns_and_jumps_of_two_inputs() {
    let turn = report(&with(&with(PLANE, "2 2, 4 (1)", "2 2, 2 (1)"), "MF4='all':'constant',[3]\n", ""));
    let finding = one(&turn, Kind::NotMonotone);
    assert_eq!(finding.variables, ["v", "w"], "along v only: {}", finding.message);
    assert_eq!(
        finding.message,
        "output `w` is not monotone along `v`: it rises where `u` is 0, and falls where `u` is 1"
    );
    let step = with(
        PLANE,
        "Range=[0 1]\nMF1='lo':'linzmf',[0 1]\nMF2='hi':'linsmf',[0 1]\n[Input2]",
        "Range=[0 1]\nMF1='lo':'linzmf',[0.5 0.5]\nMF2='hi':'linsmf',[0.5 0.5]\n[Input2]",
    );
    let report = report(&step);
    let finding = one(&report, Kind::Jump);
    assert_eq!(finding.variables, ["u", "w"], "along u only: {}", finding.message);
    let [jump] = finding.jumps.as_slice() else { panic!("one place: {:#?}", finding.jumps) };
    near(jump.inputs[0], 0.5, 0.0, "at the step");
    near(jump.size(), 2.0, 1e-9, "by two rules' difference");
    assert_eq!(report.findings.len(), 1, "nothing else: {:#?}", report.findings);
}

#[test]
fn curved_and_sampled_outputs_are_looked_at_too() {
    let curved = report(&with(SOUND, "'trimf',[1 2 3]", "'gaussmf',[0.4 2]"));
    assert!(curved.is_sampled, "no exact centroid");
    assert_eq!(curved.findings, [], "and no flaw from sampling");
    let largest = report(&with(SOUND, "Type='mamdani'\n", "Type='mamdani'\nDefuzzMethod='mom'\n"));
    let jumps = &one(&largest, Kind::Jump).jumps;
    assert!(largest.is_sampled && jumps.len() == 2, "from term to term: {jumps:#?}");
    near(jumps[0].inputs[0], 1.0, 1e-9, "where `low` and `mid` are equal");
}

#[test]
fn a_line_has_points_beside_its_jumps() {
    let step = system(&with(&with(SOUND, "'trimf',[0 2 4]", "'trapmf',[0 2 3 3]"), "[2 4 4]", "[3 4 4]"));
    let Course { points, jumps } = along(&step, 0, 0, &[0.0]).expect("runs");
    assert!(points.is_sorted_by(|a, b| a.0 < b.0), "in ascending order");
    assert_eq!((points[0].0, points[points.len() - 1].0, jumps.len()), (0.0, 4.0, 1), "over the range");
    assert!(points.iter().any(|(x, _)| *x > 3.0 && *x < 3.0 + 1e-9), "just beside the jump");
}

#[test]
fn many_inputs_and_rules_are_checked_in_bounded_time() {
    // Eight inputs of five terms, 400 rules: 5^8 combinations, of which most have no rule.
    let mut text = String::from("[System]\nType='mamdani'\n");
    for input in 1..=8 {
        text.push_str(&format!("[Input{input}]\nName='x{input}'\nRange=[0 4]\n"));
        for term in 0..5 {
            text.push_str(&format!("MF{}='t{term}':'trimf',[{} {term} {}]\n", term + 1, term - 1, term + 1));
        }
    }
    text.push_str("[Output1]\nName='y'\nRange=[0 1]\nMF1='a':'trimf',[0 0.2 0.4]\nMF2='b':'trimf',[0.6 0.8 1]\n[Rules]\n");
    let mut state = 1_u32;
    for _ in 0..400 {
        for _ in 0..8 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            text.push_str(&format!("{} ", (state >> 16) % 6));
        }
        text.push_str(&format!(", {} (1) : 1\n", 1 + (state >> 24) % 2));
    }
    let report = report(&text);
    let is_known = kinds(&report).contains(&Kind::NoRuleFires);
    assert!(is_known || !report.skipped.is_empty(), "found, or said that it was not looked for");
}

/// Law: what an output takes on includes what it is at the corners, also where no line goes.
/// Reference: with five inputs of three terms the rules of the corners alone conclude the outer terms, of centroid -0.5 and 0.5.
#[test]
fn the_reach_of_five_inputs_includes_the_corners() {
    let mut text = String::from("[System]\nName='five'\n");
    for number in 1..=5 {
        text += &format!(
            "[Input{number}]\nName='x{number}'\nRange=[-1 1]\nMF1='a':'trimf',[-2 -1 0]\nMF2='b':'trimf',[-1 0 1]\nMF3='c':'trimf',[0 1 2]\n"
        );
    }
    text += "[Output1]\nName='y'\nRange=[-1 1]\nMF1='a':'trimf',[-1 -.5 0]\nMF2='b':'trimf',[-.5 0 .5]\nMF3='c':'trimf',[0 .5 1]\n";
    text += "[Rules]\n1 1 1 1 1, 1 (1) : 1\n3 3 3 3 3, 3 (1) : 1\n0 2 0 0 0, 2 (1) : 1\n";
    let report = report(&text);
    near(report.outputs[0].reached.0, -0.5, 1e-9, "the lowest corner");
    near(report.outputs[0].reached.1, 0.5, 1e-9, "the highest corner");
    let words = report.outputs[0].to_string();
    assert!(words.contains("takes on at least [-0.5, 0.5]"), "{words}");
}

/// Law: where rules fire by rounding alone there is no jump, and nothing is taken on.
/// Reference: at the foot of `smf` the strengths of `b` and `not b'` fall together as d^2/8 and d^2/8, so that the output goes to the
/// mean of both numbers, 1.5; just beside the foot `1 - mu` rounds to 0, and the first rule is alone, with 1.
#[test]
fn rounding_at_a_smooth_foot_is_no_jump() {
    let text = "[System]
Type='sugeno'
[Input1]
Name='b'
Range=[-2 2]
MF1='up':'smf',[-2 2]
MF2='down':'zmf',[-2 2]
[Output1]
Name='y'
Range=[0 2]
MF1='one':'constant',[1]
MF2='two':'constant',[2]
[Rules]
1, 1 (1) : 1
-2, 2 (1) : 1
";
    let found = report(text);
    let jumps: Vec<_> = found.findings.iter().flat_map(|finding| &finding.jumps).collect();
    let [jump] = jumps.as_slice() else { panic!("one jump: {jumps:?}") };
    assert_eq!(jump.inputs, [-2.0], "at the foot");
    near(jump.right, 1.5, 1e-6, "the limit, up to rounding of 1 - mu at 1e-5 of the range");
    assert_eq!(found.findings.iter().filter(|finding| finding.kind == Kind::NotMonotone).count(), 0, "level");
    near(found.outputs[0].reached.1, 1.5, 1e-6, "nothing above");
    let course = along(&system(text), 0, 0, &[0.0]).expect("runs");
    assert!(
        course.points[1..].iter().all(|(_, y)| (y - 1.5).abs() < 1e-3),
        "level: {:?}",
        &course.points[..4]
    );
}
