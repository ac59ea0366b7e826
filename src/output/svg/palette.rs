//! Colours, the same in all pictures.

/// The domain's boundary.
pub const BOUNDARY: &str = "#123a6b";
/// Where something failed.
pub const FAILURE: &str = "#e00020";
/// Base triangles.
pub const TRIANGLE: &str = "#b9c3cf";
/// Crosses, and lines of secondary weight.
pub const CROSS: &str = "#2f7d4f";

/// Lines that separatrices are told apart by.
pub const LINES: [&str; 6] = ["#c2410c", "#1d6fb8", "#15803d", "#9333ea", "#b45309", "#be185d"];

/// Fills that neighbouring regions are told apart by.
pub const FILLS: [&str; 8] =
    ["#cfe3f5", "#fbe3c8", "#d5efd4", "#ecd9f2", "#fdf3b8", "#f9d4d6", "#cdeeea", "#e3e0d5"];

/// Marks by valence: few quads warm, many quads cold.
pub fn valence_color(valence: usize) -> &'static str {
    match valence {
        0..=2 => "#b91c1c",
        3 => "#e8590c",
        5 => "#1864c9",
        _ => "#7b2cbf",
    }
}

/// Tint of an element by its scaled Jacobian: red where bad, almost white where good.
pub fn quality_tint(scaled_jacobian: f64) -> String {
    const STOPS: [(f64, [f64; 3]); 5] = [
        (0.0, [214.0, 48.0, 49.0]),
        (0.3, [246.0, 150.0, 100.0]),
        (0.5, [253.0, 216.0, 155.0]),
        (0.75, [232.0, 240.0, 214.0]),
        (1.0, [222.0, 238.0, 250.0]),
    ];
    let q = if scaled_jacobian.is_finite() { scaled_jacobian.clamp(0.0, 1.0) } else { 0.0 };
    let k = STOPS.iter().skip(1).position(|s| q <= s.0).unwrap_or(STOPS.len() - 2);
    let ((a, from), (b, to)) = (STOPS[k], STOPS[k + 1]);
    let share = (q - a) / (b - a);
    let channel = |c: usize| (from[c] + (to[c] - from[c]) * share).round() as u8;
    format!("#{:02x}{:02x}{:02x}", channel(0), channel(1), channel(2))
}
