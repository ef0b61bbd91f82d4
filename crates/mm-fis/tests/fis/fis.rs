//! Law: a `.fis` text means what MATLAB's documentation says, however it is spaced and quoted; what it cannot mean is refused
//! with its place.
//!
//! Reference: the numbers of each text, read by eye. Tolerance: none, numbers are read exactly.

use mm_control::fuzzy::{And, Connective, MembershipFunction as Mf};
use mm_fis::{Accuracy, Kind, Shape, read_fis};

const TIDY: &str = "[System]
Name='tip'
Type='mamdani'
Version=2.0
NumInputs=2
NumOutputs=1
NumRules=2
AndMethod='prod'
OrMethod='probor'
ImpMethod='min'
AggMethod='sum'
DefuzzMethod='centroid'

[Input1]
Name='service'
Range=[0 10]
NumMFs=2
MF1='poor':'gaussmf',[1.5 0]
MF2='good':'gaussmf',[1.5 10]

[Input2]
Name='food'
Range=[0 10]
NumMFs=1
MF1='rancid':'trapmf',[0 0 1 3]

[Output1]
Name='tip'
Range=[0 30]
NumMFs=2
MF1='cheap':'trimf',[0 5 10]
MF2='generous':'trimf',[20 25 30]

[Rules]
1 1, 1 (1) : 2
2 -1, 2 (0.5) : 1
";

const WILD: &str = "\u{feff}% a tip\r\n  # of old\r\n[ rules ]\r\n 1,1,1(1.):2 // first\r\n\t2\t-1 , 2 ( 5e-1 ) :1\r\n
[OUTPUT1] % out\rname = \"tip\"\rRANGE = [ 0,30 ]\rmf2 = generous : trimf , [ 20, 25 30 ]\rMF1=cheap:trimf [0 +5 1e1] % low
[input2]
Name=food
Range=[0 10]
MF1 = 'rancid' : 'TRAPMF' , [0 0 1 3]
[Input1]
Range=[-0 10.]
NumMFs=2
Name=service % no quotes
MF1=\u{2018}poor\u{2019}:\u{2018}gaussmf\u{2019},[1.5 0]
MF2=\"good\":\"gaussmf\",[1.5 10]
[System]
name = tip
andmethod=PROD
ORMethod=\"probor\"
AggMethod=sum";

#[test]
fn spacing_quotes_order_and_case_do_not_matter() {
    let tidy = read_fis(TIDY).unwrap().system;
    assert_eq!((tidy.kind, tidy.and), (Kind::Mamdani, And::Prod), "head");
    assert_eq!(tidy.rules[1].inputs, [2, -1], "second rule");
    assert_eq!((tidy.rules[1].weight, tidy.rules[0].connective), (0.5, Connective::Or), "weight, connective");
    assert_eq!(tidy.inputs[1].terms[0].shape, Shape::Set(Mf::Trapezoid([0.0, 0.0, 1.0, 3.0])), "rancid");
    let wild = read_fis(WILD).unwrap_or_else(|error| panic!("{error}")).system;
    assert_eq!(tidy, wild, "the same system");
    tidy.with_engine(Accuracy::Exact, |_| ()).unwrap();
}

#[test]
fn every_problem_is_found_at_its_place() {
    let text = TIDY
        .replace("MF1='poor':'gaussmf'", "MF1='poor':'gausmf'")
        .replace("[20 25 30]", "[20 35 30]")
        .replace("2 -1, 2 (0.5) : 1", "2 -1, 3 (0.5) : 1")
        .replace("NumMFs=1", "NumMFs=999999999999999999999");
    let error = read_fis(&text).unwrap_err();
    let lines: Vec<_> = error.problems().iter().map(|problem| (problem.line(), problem.column())).collect();
    assert_eq!(lines, [(18, 13), (24, 8), (32, 31), (36, 7)], "{error}");
    let first = &error.problems()[0];
    assert_eq!(&text[first.span()], "gausmf", "span");
    assert_eq!(first.nearest(), Some("gaussmf"), "nearest");
    assert!(
        first
            .to_string()
            .starts_with("line 18, column 13: unknown membership function `gausmf`; expected `trimf`,"),
        "{first}"
    );
}

#[test]
fn the_format_is_told_by_ending_or_by_the_text() {
    let fcl = include_str!("../corpus/good/tipper.fcl");
    for (name, text, system) in [
        ("a.fis", TIDY, "tip"),
        ("dir.fcl/a.FIS", TIDY, "tip"),
        ("a", TIDY, "tip"),
        ("-", WILD, "tip"),
        ("a.FCL", fcl, "tipper"),
        ("a.txt", fcl, "tipper"),
    ] {
        let read = mm_fis::read(name, text).map(|document| document.system.name);
        assert_eq!(read.as_deref(), Ok(system), "{name}");
    }
    let wrong = mm_fis::read("a.fis", fcl).unwrap_err();
    assert_eq!(wrong.problems()[0].expected(), Some("`[System]`"), "{wrong}");
}
