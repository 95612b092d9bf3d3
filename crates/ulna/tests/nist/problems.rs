//! The problems: files as NIST distributes them, models as the files print them.

use crate::dual::Dual;
use std::f64::consts::PI;
use std::path::Path;

/// What a model predicts at the predictors of a row, given b1, b2, …: `y`, or whatever it predicts of it.
type Model = fn(&[Dual], &[f64]) -> Dual;

/// Name of the file, and the model.
pub const MODELS: [(&str, Model); 27] = [
    ("Bennett5", |b, x| b[0] * (b[1] + x[0]).power(Dual::from(-1.0) / b[2])),
    ("BoxBOD", saturation),
    ("Chwirut1", |b, x| (-b[0] * x[0]).exp() / (b[1] + b[2] * x[0])),
    ("Chwirut2", |b, x| (-b[0] * x[0]).exp() / (b[1] + b[2] * x[0])),
    ("DanWood", |b, x| b[0] * (b[1] * x[0].ln()).exp()),
    ("ENSO", |b, x| {
        let turn = |period: Dual| Dual::from(2.0 * PI * x[0]) / period;
        let wave = |turn: Dual, cos: Dual, sin: Dual| cos * turn.cos() + sin * turn.sin();
        b[0] + wave(turn(12.0.into()), b[1], b[2]) + wave(turn(b[3]), b[4], b[5]) + wave(turn(b[6]), b[7], b[8])
    }),
    ("Eckerle4", |b, x| (b[0] / b[1]) * (((-b[2] + x[0]) / b[1]).squared() * -0.5).exp()),
    ("Gauss1", gauss),
    ("Gauss2", gauss),
    ("Gauss3", gauss),
    ("Hahn1", cubics),
    ("Kirby2", |b, x| (b[0] + b[1] * x[0] + b[2] * x[0] * x[0]) / (b[3] * x[0] + b[4] * x[0] * x[0] + 1.0)),
    ("Lanczos1", lanczos),
    ("Lanczos2", lanczos),
    ("Lanczos3", lanczos),
    ("MGH09", |b, x| b[0] * (b[1] * x[0] + x[0] * x[0]) / (b[2] * x[0] + x[0] * x[0] + b[3])),
    ("MGH10", |b, x| b[0] * (b[1] / (b[2] + x[0])).exp()),
    ("MGH17", |b, x| b[0] + b[1] * (-b[3] * x[0]).exp() + b[2] * (-b[4] * x[0]).exp()),
    ("Misra1a", saturation),
    ("Misra1b", |b, x| b[0] * (-(Dual::from(1.0) / (b[1] * x[0] / 2.0 + 1.0).squared()) + 1.0)),
    ("Misra1c", |b, x| b[0] * (-(Dual::from(1.0) / (b[1] * 2.0 * x[0] + 1.0).sqrt()) + 1.0)),
    ("Misra1d", |b, x| b[0] * b[1] * x[0] / (b[1] * x[0] + 1.0)),
    ("Nelson", |b, x| b[0] - b[1] * x[0] * (-b[2] * x[1]).exp()),
    ("Rat42", |b, x| b[0] / ((b[1] - b[2] * x[0]).exp() + 1.0)),
    ("Rat43", |b, x| b[0] / ((b[1] - b[2] * x[0]).exp() + 1.0).power(Dual::from(1.0) / b[3])),
    ("Roszman1", |b, x| b[0] - b[1] * x[0] - (b[2] / (-b[3] + x[0])).atan() / PI),
    ("Thurber", cubics),
];

fn saturation(b: &[Dual], x: &[f64]) -> Dual {
    b[0] * (-(-b[1] * x[0]).exp() + 1.0)
}

fn gauss(b: &[Dual], x: &[f64]) -> Dual {
    let peak = |height: Dual, at: Dual, width: Dual| height * (-((-at + x[0]) / width).squared()).exp();
    b[0] * (-b[1] * x[0]).exp() + peak(b[2], b[3], b[4]) + peak(b[5], b[6], b[7])
}

fn cubics(b: &[Dual], x: &[f64]) -> Dual {
    let [one, two, three] = [x[0], x[0].powi(2), x[0].powi(3)];
    (b[0] + b[1] * one + b[2] * two + b[3] * three) / (b[4] * one + b[5] * two + b[6] * three + 1.0)
}

fn lanczos(b: &[Dual], x: &[f64]) -> Dual {
    (0..3).map(|k| b[2 * k] * (-b[2 * k + 1] * x[0]).exp()).fold(0.0.into(), |sum: Dual, term| sum + term)
}

/// What a file says.
pub struct Problem {
    pub starts: [Vec<f64>; 2],
    pub parameters: Vec<f64>,
    pub deviations: Vec<f64>,
    pub cost: f64,
    pub y: Vec<f64>,
    pub x: Vec<Vec<f64>>,
}

/// Reads a file of the reference data sets. Nelson's model is of log y.
pub fn problem(name: &str) -> Problem {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/strd");
    let text = std::fs::read_to_string(folder.join(format!("{name}.dat"))).unwrap();
    let numbers = |words: &str| words.split_whitespace().map(|word| word.parse().ok()).collect::<Option<Vec<f64>>>();
    let (mut columns, mut cost, mut count) = (vec![vec![]; 4], f64::NAN, 0);
    let mut lines = text.lines();
    for line in lines.by_ref() {
        match line.split_once(['=', ':']) {
            // start 1, start 2, certified value, its standard deviation
            Some((b, row)) if b.trim().strip_prefix('b').is_some_and(|k| k.parse::<usize>().is_ok()) => {
                let row = numbers(row).filter(|row| row.len() == 4).unwrap();
                columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
            }
            Some(("Residual Sum of Squares", value)) => cost = value.trim().parse().unwrap(),
            Some(("Number of Observations", value)) => count = value.trim().parse().unwrap(),
            Some(("Data", heads)) if heads.trim_start().starts_with('y') => break,
            _ => {}
        }
    }
    let rows: Vec<Vec<f64>> = lines.filter(|line| !line.trim().is_empty()).map(|line| numbers(line).unwrap()).collect();
    assert!(rows.len() == count && cost.is_finite() && !columns[0].is_empty(), "{name}");
    let seen = |y: f64| if name == "Nelson" { y.ln() } else { y };
    let [one, two, parameters, deviations] = <[Vec<f64>; 4]>::try_from(columns).unwrap();
    Problem {
        starts: [one, two],
        parameters,
        deviations,
        cost,
        y: rows.iter().map(|row| seen(row[0])).collect(),
        x: rows.into_iter().map(|row| row[1..].to_vec()).collect(),
    }
}
