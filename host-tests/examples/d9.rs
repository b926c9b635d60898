//! scratch
use antinode::period::MeanReturnDetector;
fn main() {
    for s in 0..6 { let p = 4.3 + 0.1 * s as f64; let mut d = MeanReturnDetector::new();
    println!("P {p}");
    for k in 0..120 { let x = std::f64::consts::TAU * k as f64 / p; if let Some(q) = d.push([(0.8 * (x + s as f64).cos()) as f32, (0.3 * (x + s as f64).cos()) as f32]) { println!("found {q} at {k}"); break; } } }
}
