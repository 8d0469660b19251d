//! Gloss: the transformed cosine that stands for a rough mirror seen from a direction, by the tables `ltc_matrix`,
//! `ltc_albedo` and `ltc`.

use glam::DVec3;

use super::point::{Shape, unit};
use super::tabulated::numbers;
use crate::diag::Failure;
use crate::eval::Batch;
use crate::scene::matter::Gloss;
use crate::technique::tables::{LTC, LTC_ALBEDO, LTC_MATRIX};

/// Rows and columns of the tables, whose texels are told apart by them.
const SIZE: usize = 64;

/// The reflection of light by a glossy surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sheen {
    /// The transform of its directions.
    pub(super) shape: Shape,
    /// The share of that which it sends on.
    pub(super) share: f64,
}

/// A view of a glossy surface: the gloss, the unit normal and the direction of the viewer.
pub(super) type Seen = (Gloss, DVec3, DVec3);

/// The sheen of some surfaces.
///
/// # Errors
/// Never for the tables that come with Umbrage, which are tested.
pub(super) fn sheens(seen: &[Seen]) -> Result<Vec<Sheen>, Failure> {
    if seen.is_empty() {
        return Ok(Vec::new());
    }
    let (matrices, albedos) = (numbers(&LTC_MATRIX)?, numbers(&LTC_ALBEDO)?);
    let roughness = seen.iter().map(|(gloss, ..)| gloss.roughness).collect();
    let across = evaluated("column", ["roughness"], [roughness])?;
    let cosine = |(_, normal, view): &Seen| normal.dot(unit(*view)).clamp(0.0, 1.0);
    let sine = |(_, normal, view): &Seen| normal.cross(unit(*view)).length_squared();
    let along = evaluated(
        "row",
        ["cosine", "sine_square"],
        [seen.iter().map(cosine).collect(), seen.iter().map(sine).collect()],
    )?;
    let place = |at: f64| (at as usize).min(SIZE - 2);
    let mut entries = Vec::new();
    // Four entries of the matrix, and two shares.
    for entry in 0..6 {
        let texel = |row: usize, column: usize| match entry {
            0..4 => matrices[row * SIZE + column][entry],
            _ => albedos[row * SIZE + column][entry - 4],
        };
        let at = |down: usize, right: usize| -> Vec<f64> {
            along.iter().zip(&across).map(|(row, column)| texel(place(*row) + down, place(*column) + right)).collect()
        };
        let beyond = |all: &[f64]| all.iter().map(|at| at - place(*at) as f64).collect();
        entries.push(evaluated(
            "blend",
            ["v00", "v01", "v10", "v11", "fx", "fy"],
            [at(0, 0), at(0, 1), at(1, 0), at(1, 1), beyond(&across), beyond(&along)],
        )?);
    }
    let reflectance = seen.iter().map(|(gloss, ..)| gloss.reflectance).collect();
    let shares = [entries[4].clone(), entries[5].clone(), reflectance];
    let shares = evaluated("share", ["albedo", "fresnel", "reflectance"], shares)?;
    let sheen = |(index, (_, _, view)): (usize, &Seen)| {
        let [a, b, c, d] = std::array::from_fn(|entry| entries[entry][index]);
        let inverse = [[a, 0.0, b], [0.0, 1.0, 0.0], [c, 0.0, d]];
        Sheen { shape: Shape { view: *view, inverse }, share: shares[index] }
    };
    Ok(seen.iter().enumerate().map(sheen).collect())
}

/// A function of the table `ltc` at some points.
fn evaluated<const N: usize>(function: &str, names: [&str; N], numbers: [Vec<f64>; N]) -> Result<Vec<f64>, Failure> {
    let program = LTC.function(function)?;
    super::integral::values(&mut Batch::new(program), program, names, numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheen(roughness: f64, reflectance: f64, view: DVec3) -> Sheen {
        let seen = (Gloss { roughness, reflectance }, DVec3::Z, view);
        sheens(&[seen]).unwrap_or_else(|error| panic!("{error}"))[0]
    }

    /// The fit has what an independent one has, and what was published: (column, row), then a, c, b, d, albedo and
    /// Fresnel's part.
    #[test]
    fn texels_have_the_anchors_of_the_fit() {
        type Anchor = ([usize; 2], [f64; 4], f64, Option<f64>);
        let anchors: [Anchor; 7] = [
            ([63, 0], [1.0, 0.0, 0.0, 1.12813], 0.306974, Some(3.4e-5)),
            ([32, 0], [1.0, 0.0, 0.0, 0.49559], 0.912293, None),
            ([16, 0], [1.0, 0.0, 0.0, 0.129153], 0.999894, None),
            ([48, 32], [0.881994, -0.251946, 0.407223, 0.790189], 0.620177, Some(0.00168482)),
            ([32, 32], [0.626092, -0.219644, 0.531595, 0.312202], 0.88238, Some(0.00296637)),
            ([24, 48], [0.206679, -0.106499, 0.421425, 0.0680078], 0.924543, Some(0.053122)),
            ([16, 16], [0.875897, -0.0425993, 0.330733, 0.113093], 0.999523, None),
        ];
        let table = |table| numbers(table).unwrap_or_else(|error| panic!("{error}"));
        let (matrices, albedos) = (table(&LTC_MATRIX), table(&LTC_ALBEDO));
        for ([column, row], [a, c, b, d], albedo, fresnel) in anchors {
            let place = row * SIZE + column;
            for (found, expected) in matrices[place].iter().zip([a, b, c, d]) {
                assert!((found - expected).abs() < 4e-4, "{column} {row}: {:?}", matrices[place]);
            }
            let [of_albedo, of_fresnel] = [albedos[place][0], albedos[place][1]];
            assert!((of_albedo - albedo).abs() < 1e-5, "{column} {row}: {of_albedo}");
            assert!(fresnel.is_none_or(|fresnel| (of_fresnel - fresnel).abs() < 1e-5), "{column} {row}: {of_fresnel}");
        }
    }

    #[test]
    fn a_sheen_is_blended_from_four_texels() {
        let table = |table| numbers(table).unwrap_or_else(|error| panic!("{error}"));
        let (matrices, albedos) = (table(&LTC_MATRIX), table(&LTC_ALBEDO));
        // On a texel: roughness 32/63, and a cosine of 1 - (16/63)^2.
        let cosine = 1.0 - (16.0_f64 / 63.0).powi(2);
        let view = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
        let found = sheen(32.0 / 63.0, 0.2, 3.0 * view);
        let (matrix, shares) = (&matrices[16 * SIZE + 32], &albedos[16 * SIZE + 32]);
        let expected = [[matrix[0], 0.0, matrix[1]], [0.0, 1.0, 0.0], [matrix[2], 0.0, matrix[3]]];
        for (found, expected) in found.shape.inverse.as_flattened().iter().zip(expected.as_flattened()) {
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
        assert!((found.share - (0.2 * shares[0] + 0.8 * shares[1])).abs() < 1e-9, "{found:?}");
        // At the ends of the table.
        assert_eq!(sheen(1.0, 1.0, DVec3::Z).shape.inverse[2][2], matrices[63][3]);
        assert!(sheen(0.0, 1.0, DVec3::X).share.is_finite());
        let between = sheen(32.5 / 63.0, 1.0, DVec3::Z).shape.inverse[2][2];
        assert!((between - 0.5 * (matrices[32][3] + matrices[33][3])).abs() < 1e-9);
    }
}
