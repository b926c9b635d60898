//! The methods of a window as columns.

use std::sync::LazyLock;

use antinode::methods::comparison::{Comparison, Method};
use serde::ser::{Serialize, Serializer};

use super::Methods;
use crate::digits::significant;

/// A value of a column.
#[derive(Debug, Clone, serde::Serialize)]
#[serde(untagged)]
pub enum Field {
    Number(f64),
    Count(u8),
    Text(String),
    /// The window holds no wave, or its samples were not kept.
    Missing,
}

/// Columns of one method, each prefixed by its name and an underscore. `sigma`: in standard deviations.
const OF_A_METHOD: [&str; 12] = [
    "main_amplitude",
    "quadrature_amplitude",
    "angle_rad",
    "frequency_hz",
    "j",
    "main_amplitude_off_sigma",
    "quadrature_amplitude_off_sigma",
    "angle_off_sigma",
    "frequency_off_sigma",
    "unexplained_sigma",
    "failed_conditions",
    "rank",
];
/// Columns of all methods together.
const OF_ALL: [&str; 7] = [
    "leakage",
    "delay_imbalance",
    "delay_imbalance_off_sigma",
    "phase_difference_rad",
    "phase_difference_off_sigma",
    "methods_by_rank",
    "methods_flag",
];

/// The names of all columns, in order.
pub static NAMES: LazyLock<Vec<String>> = LazyLock::new(|| {
    let of_methods = (1..=4).flat_map(|i| OF_A_METHOD.map(|name| format!("method{i}_{name}")));
    of_methods.chain(OF_ALL.map(String::from)).collect()
});

/// The values of all columns, in order.
pub fn fields(methods: Option<&Methods>) -> Vec<Field> {
    let Some(methods) = methods else {
        return vec![Field::Missing; NAMES.len()];
    };
    let mut fields = Vec::new();
    let comparison = &methods.comparison;
    for (i, method) in comparison.methods.iter().enumerate() {
        let shape = method.wave.shape;
        let [main, quadrature, angle] = method.differences;
        fields.extend(
            [
                shape.main_amplitude,
                shape.quadrature_amplitude,
                shape.angle,
                methods.frequencies[i],
                method.j,
                main,
                quadrature,
                angle,
                methods.frequency_differences[i],
                worst(method),
            ]
            .map(|x| Field::Number(rounded(x))),
        );
        fields.push(Field::Text(method.conditions.to_string()));
        fields.push(Field::Count(method.rank));
    }
    fields.extend(
        [
            comparison.leakage,
            comparison.imbalance,
            comparison.imbalance_excess,
            comparison.phase_difference,
            comparison.phase_excess,
        ]
        .map(|x| Field::Number(rounded(x))),
    );
    fields.push(Field::Text(by_rank(comparison)));
    let flag = if comparison.disagree { "disagree" } else { "" };
    fields.push(Field::Text(flag.to_owned()));
    fields
}

/// Nine significant digits; zero has no sign.
fn rounded(x: f64) -> f64 {
    significant(x, 9) + 0.0
}

/// The largest difference from the exact solution that leakage and noise do not explain, as a multiple of what they may cause.
pub fn worst(method: &Method) -> f64 {
    // NaN is worst of all, and the greatest in this order.
    let sizes = method.unexplained.map(f64::abs).into_iter();
    sizes.max_by(f64::total_cmp).unwrap_or(0.0)
}

/// The methods from the most trusted to the least: `4>3>2>1`.
fn by_rank(comparison: &Comparison) -> String {
    let mut order = [1, 2, 3, 4];
    order.sort_by_key(|i| comparison.methods[i - 1].rank);
    order.map(|i| i.to_string()).join(">")
}

/// The columns as members of a JSON object.
pub struct Columns<'a>(pub Option<&'a Methods>);

impl Serialize for Columns<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(NAMES.iter().zip(fields(self.0)))
    }
}

#[cfg(test)]
mod tests {
    use antinode::{Identifier, Settings};
    use antinode_sim::{Flaws, Gyro, Wave};

    use super::*;
    use crate::methods::History;

    /// The last window of the paper's wave in noise, after it has gone through `change`.
    fn last(change: impl Fn([f32; 2]) -> [f32; 2]) -> Methods {
        let settings = Settings::new(1e5);
        let flaws = Flaws {
            noise: 0.002,
            offset_c: 0.3,
            ..Flaws::default()
        };
        let mut core = Box::new(Identifier::<f32, 256, 64>::new(settings).expect("valid settings"));
        let mut history = History::new(&settings, 200);
        let mut found = None;
        for pair in Gyro::new(Wave::default(), flaws, 1e5, 1)
            .expect("a valid gyro")
            .take(3000)
        {
            let pair = change(pair.map(|x| x as f32));
            history.extend(&[pair]);
            if let Some(estimate) = core.push(pair) {
                found = history.compare(&estimate);
            }
        }
        found.expect("a window")
    }

    #[test]
    fn every_column_has_its_value() {
        let methods = last(|pair| pair);
        let fields = fields(Some(&methods));
        assert_eq!(
            (NAMES.len(), fields.len(), super::fields(None).len()),
            (55, 55, 55)
        );
        let value =
            |name: &str| match fields[NAMES.iter().position(|n| n == name).expect("a column")] {
                Field::Number(x) => x,
                Field::Count(n) => n.into(),
                _ => panic!("{name} is no number"),
            };
        // 188 samples are 10.02 periods: 0.24 % leak.
        assert!((value("method4_main_amplitude") - 2.0).abs() < 0.006);
        assert!((value("method3_quadrature_amplitude") - 0.1).abs() < 0.01);
        assert!((value("method2_quadrature_amplitude") - 0.1).abs() < 0.01);
        assert!((value("method1_angle_rad") - std::f64::consts::FRAC_PI_6).abs() < 0.002);
        assert!((value("leakage") - 0.0024).abs() < 2e-4);
        for i in 1..=4 {
            assert!((value(&format!("method{i}_frequency_hz")) - 5332.0).abs() < 1.0);
        }
        // Noise alone makes J 8·10⁻⁶; a_A off by 0.1 % of 2 adds half the square of that.
        assert!(
            (6e-6..6e-4).contains(&value("method4_j")) && value("method1_j") > value("method4_j")
        );
        let text = serde_json::to_string(&Columns(Some(&methods))).expect("JSON");
        assert!(
            text.contains("\"methods_flag\":\"\"") && text.contains("\"method1_rank\":4"),
            "{text}"
        );
    }
}
