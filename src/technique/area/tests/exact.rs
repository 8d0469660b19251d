//! The visible part of a light in whole numbers: an independent program, without tables and without rounding, that
//! knows occluders as flat polygons only. Directions matter and lengths do not, so that nothing is ever divided.

use num_bigint::{BigInt, Sign};

/// A direction, in lowest terms.
pub(super) type Direction = [BigInt; 3];
/// Whole coordinates.
pub(super) type Whole = [i64; 3];

fn big(a: Whole) -> Direction {
    a.map(BigInt::from)
}

fn minus(a: &Direction, b: &Direction) -> Direction {
    std::array::from_fn(|axis| &a[axis] - &b[axis])
}

fn dot(a: &Direction, b: &Direction) -> BigInt {
    (0..3).map(|axis| &a[axis] * &b[axis]).sum()
}

fn cross(a: &Direction, b: &Direction) -> Direction {
    let of = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    [of(1, 2), of(2, 0), of(0, 1)]
}

fn reduced(a: Direction) -> Direction {
    let zero = BigInt::ZERO;
    let divisor = a.iter().fold(zero.clone(), |mut x, y| {
        let mut y = y.clone();
        while y != zero {
            (x, y) = (y.clone(), x % y);
        }
        x
    });
    let divisor = BigInt::from_biguint(Sign::Plus, divisor.magnitude().clone());
    if divisor == zero { a } else { a.map(|x| x / &divisor) }
}

/// The nearest numbers to a direction, scaled so that they are finite.
fn numbers(a: &Direction) -> [f64; 3] {
    let bits = a.iter().map(|x| x.bits()).max().unwrap_or_default().saturating_sub(200);
    a.clone().map(|x| {
        let text = (x >> bits).to_string();
        text.parse().expect("a whole number is a number")
    })
}

/// The part of a loop where a height is positive.
fn clip(corners: &[Direction], height: impl Fn(&Direction) -> BigInt) -> Vec<Direction> {
    let zero = BigInt::ZERO;
    let mut part = Vec::new();
    for (index, a) in corners.iter().enumerate() {
        let b = &corners[(index + 1) % corners.len()];
        let (ha, hb) = (height(a), height(b));
        if ha >= zero {
            part.push(a.clone());
        }
        if (ha > zero && hb < zero) || (ha < zero && hb > zero) {
            let (pa, pb) = (BigInt::from(ha.magnitude().clone()), BigInt::from(hb.magnitude().clone()));
            part.push(reduced(std::array::from_fn(|axis| &a[axis] * &pb + &b[axis] * &pa)));
        }
    }
    if part.len() < 3 { Vec::new() } else { part }
}

fn area(corners: &[Direction]) -> Direction {
    let sides = corners[1..].windows(2).map(|pair| cross(&minus(&pair[0], &corners[0]), &minus(&pair[1], &corners[0])));
    sides.fold(big([0; 3]), |sum, side| std::array::from_fn(|axis| &sum[axis] + &side[axis]))
}

/// The inward planes of a flat convex polygon before the plane `normal . p = height` of a light, as seen from the
/// origin; none if it hides nothing.
fn planes(corners: &[Whole], normal: &Direction, height: &BigInt) -> Vec<Direction> {
    let corners: Vec<Direction> = corners.iter().copied().map(big).collect();
    // Heights are not those of directions: corners are clipped as points, each with a weight.
    let own = area(&corners);
    let facing = dot(&own, &corners[0]);
    if facing == BigInt::ZERO {
        return Vec::new();
    }
    let side = |at: &Direction| height - dot(normal, at);
    let mut before = Vec::new();
    for (index, a) in corners.iter().enumerate() {
        let b = &corners[(index + 1) % corners.len()];
        // The origin is at `height`, which is positive.
        let (ha, hb) = (side(a), side(b));
        if ha > BigInt::ZERO {
            before.push(a.clone());
        }
        if (ha > BigInt::ZERO) != (hb > BigInt::ZERO) {
            // a hb - b ha, over hb - ha, lies on the plane; the sign makes the divisor positive.
            let at: Direction = std::array::from_fn(|axis| &a[axis] * &hb - &b[axis] * &ha);
            before.push(reduced(if &hb - &ha > BigInt::ZERO { at } else { at.map(|x| -x) }));
        }
    }
    if facing > BigInt::ZERO {
        before.reverse();
    }
    let next = before.iter().cycle().skip(1);
    let sides = before.iter().zip(next).map(|(from, to)| cross(to, from));
    sides.filter(|side| *side != big([0; 3])).map(reduced).collect()
}

/// Form factor, share of the area, and share of the area above the horizon of a light behind flat polygons, as seen
/// from the origin; `None` in its plane.
pub(super) fn visible(light: &[Whole], normal: Whole, occluders: &[Vec<Whole>]) -> Option<[f64; 3]> {
    let mut corners: Vec<Direction> = light.iter().copied().map(big).collect();
    let mut own = area(&corners);
    let mut height = dot(&own, &corners[0]);
    if height == BigInt::ZERO {
        return None;
    }
    if height < BigInt::ZERO {
        own = own.map(|x| -x);
        height = -height;
    } else {
        corners.reverse();
    }
    let cones: Vec<Vec<Direction>> =
        occluders.iter().map(|corners| planes(corners, &own, &height)).filter(|planes| !planes.is_empty()).collect();
    let whole = plane_area(&corners, &own, &height);
    let up = big(normal);
    let above = clip(&corners, |at| dot(&up, at));
    let share =
        |pieces: &[Vec<Direction>]| pieces.iter().map(|piece| plane_area(piece, &own, &height)).sum::<f64>() / whole;
    let (all, lit) = (peeled(corners, &cones), peeled(above, &cones));
    let length = numbers(&up).iter().map(|x| x * x).sum::<f64>().sqrt();
    let unit = numbers(&up).map(|x| x / length);
    Some([lit.iter().map(|piece| factor(piece, unit)).sum(), share(&all), share(&lit)])
}

fn peeled(corners: Vec<Direction>, cones: &[Vec<Direction>]) -> Vec<Vec<Direction>> {
    let mut pieces = if corners.is_empty() { Vec::new() } else { vec![corners] };
    for cone in cones {
        let mut left = Vec::new();
        for mut rest in pieces {
            for plane in cone {
                let outside = clip(&rest, |at| -dot(plane, at));
                left.extend((!outside.is_empty()).then_some(outside));
                rest = clip(&rest, |at| dot(plane, at));
                if rest.is_empty() {
                    break;
                }
            }
        }
        pieces = left;
    }
    pieces
}

/// The area, twice over, of the piece of the plane `own . p = height` that is seen in a loop of directions.
fn plane_area(corners: &[Direction], own: &Direction, height: &BigInt) -> f64 {
    let [height] = [height].map(|height| numbers(&[height.clone(), BigInt::ZERO, BigInt::ZERO])[0]);
    let normal = numbers(own);
    let points: Vec<[f64; 3]> = corners
        .iter()
        .map(|corner| {
            let corner = numbers(corner);
            let along: f64 = (0..3).map(|axis| normal[axis] * corner[axis]).sum();
            corner.map(|x| x * (height / along))
        })
        .collect();
    let side = |at: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|axis| at[axis] - points[0][axis]) };
    let sum = points[1..].windows(2).fold([0.0; 3], |sum, pair| {
        let (a, b) = (side(&pair[0]), side(&pair[1]));
        let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        std::array::from_fn(|axis| sum[axis] + cross[axis])
    });
    sum.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The form factor of a loop, each angle by its tangent.
fn factor(corners: &[Direction], normal: [f64; 3]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    let term = |(from, to): (&Direction, &Direction)| {
        let normals = numbers(&cross(to, from));
        let sine = normals.iter().map(|x| x * x).sum::<f64>().sqrt();
        let cosine = numbers(&[dot(from, to), BigInt::ZERO, BigInt::ZERO])[0];
        // The two are scaled alike unless they are huge, which reduced directions are not.
        let along: f64 = (0..3).map(|axis| normals[axis] * normal[axis]).sum();
        if sine == 0.0 { 0.0 } else { libm::atan2(sine, cosine) * along / sine }
    };
    corners.iter().zip(next).map(term).sum::<f64>().abs() / std::f64::consts::TAU
}
