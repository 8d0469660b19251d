//! Views: the map from the world to the square in which a camera or a light sees it.
//!
//! Matrices follow WebGPU: x and y from -1 to 1 with y up, depth from 0 (near) to 1.
//! Rows of pictures and of shadow maps grow downwards, so v = (1 - y) / 2. They
//! are kept in double precision: a shadow map tells depths apart that differ by
//! millionths.

use glam::{DMat4, DVec2, DVec3, DVec4};

/// The viewpoint of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// Its place.
    pub eye: DVec3,
    /// A place in the middle of the picture.
    pub target: DVec3,
    /// Angle of view from bottom to top, in degrees.
    pub angle: f64,
}

/// A map between the world and the square, or picture, that it is seen in.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// World → clip space.
    pub matrix: DMat4,
    inverse: DMat4,
    origin: Origin,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Origin {
    /// All rays start here.
    Point(DVec3),
    /// All rays go this way, and start on the near plane.
    Far(DVec3),
}

/// A plane of the world as depth over the square of a light: `depth + u * du + v * dv`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    depth: f64,
    /// Change of the depth from the left border to the right one.
    pub du: f64,
    /// Change of the depth from the top to the bottom.
    pub dv: f64,
}

impl Plane {
    /// The depth at a place of the square.
    pub fn at(&self, u: f64, v: f64) -> f64 {
        self.depth + u * self.du + v * self.dv
    }
}

/// An up direction that is not along `forward`.
fn up(forward: DVec3) -> DVec3 {
    if forward.cross(DVec3::Y).length() > 1e-3 * forward.length() { DVec3::Y } else { DVec3::Z }
}

impl Camera {
    /// The view of a picture of some width and height.
    pub fn view(&self, width: u32, height: u32) -> View {
        let forward = (self.target - self.eye).normalize();
        let look = glam::dcamera::rh::view::look_at_mat4(self.eye, self.target, up(forward));
        let aspect = f64::from(width) / f64::from(height);
        // How far one can see does not matter to rays, and little to a depth buffer of floats.
        let near = 1e-3 * (self.target - self.eye).length();
        let project = glam::dcamera::rh::proj::directx::perspective(self.angle.to_radians(), aspect, near, near * 1e6);
        View::new(project * look, Origin::Point(self.eye))
    }
}

impl View {
    fn new(matrix: DMat4, origin: Origin) -> Self {
        Self { matrix, inverse: matrix.inverse(), origin }
    }

    /// The square that parallel light sees: `casts` lies within it, and depth spans `all`.
    pub(crate) fn along(direction: DVec3, casts: &[DVec3], all: &[DVec3]) -> Self {
        let forward = direction.normalize();
        let look = glam::dcamera::rh::view::look_to_mat4(DVec3::ZERO, forward, up(forward));
        let bounds = |points: &[DVec3]| {
            let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            points.iter().map(|p| look.transform_point3(*p)).fold(start, |(lo, hi), p| (lo.min(p), hi.max(p)))
        };
        let (lo, hi) = bounds(casts);
        let (far, near) = (bounds(all).0.z, bounds(all).1.z);
        let centre = (lo + hi) / 2.0;
        // A margin keeps silhouettes off the border, where runs end.
        let half = 0.52 * (hi - lo).truncate().max_element().max(1e-6);
        let slack = 0.01 * (near - far).max(half);
        let project = glam::dcamera::rh::proj::directx::orthographic(
            centre.x - half,
            centre.x + half,
            centre.y - half,
            centre.y + half,
            -(near + slack),
            -(far - slack),
        );
        Self::new(project * look, Origin::Far(forward))
    }

    /// The square that holds a cone of light, its angle in degrees; depth spans `all`.
    pub(crate) fn cone(position: DVec3, target: DVec3, angle: f64, all: &[DVec3]) -> Self {
        let forward = (target - position).normalize();
        let look = glam::dcamera::rh::view::look_at_mat4(position, target, up(forward));
        let depths = all.iter().map(|p| -look.transform_point3(*p).z);
        let (near, far) = depths.fold((f64::INFINITY, 0.0_f64), |(near, far), d| (near.min(d), far.max(d)));
        let far = far.max(1e-3) * 1.01;
        let near = (near * 0.99).clamp(0.02 * far, 0.9 * far);
        let project = glam::dcamera::rh::proj::directx::perspective(angle.to_radians(), 1.0, near, far);
        Self::new(project * look, Origin::Point(position))
    }

    /// The place of the square in which a place of the world is seen: across and down from 0 to 1, and depth. `None` behind the viewer.
    pub fn project(&self, place: DVec3) -> Option<(DVec2, f64)> {
        let clip = self.matrix * place.extend(1.0);
        let at = clip.truncate() / clip.w;
        (clip.w > 0.0).then(|| (DVec2::new(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y), at.z))
    }

    /// The ray through a place of the square: start and direction of length 1.
    pub(crate) fn ray(&self, u: f64, v: f64) -> (DVec3, DVec3) {
        let at = |depth: f64| {
            let place = self.inverse * DVec4::new(2.0 * u - 1.0, 1.0 - 2.0 * v, depth, 1.0);
            place.truncate() / place.w
        };
        match self.origin {
            Origin::Point(point) => (point, (at(0.5) - point).normalize()),
            Origin::Far(direction) => (at(0.0), direction),
        }
    }

    /// The plane through three places, as depth over the square; `None` if it is seen edge-on.
    pub fn plane(&self, corners: [DVec3; 3]) -> Option<Plane> {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        // Planes are mapped by the transposed inverse.
        let plane = self.inverse.transpose() * normal.extend(-normal.dot(a));
        let [x, y, z, w] = plane.to_array();
        // Solved for the depth, with x = 2u - 1 and y = 1 - 2v.
        let plane = Plane { depth: (x - y - w) / z, du: -2.0 * x / z, dv: 2.0 * y / z };
        (plane.depth.is_finite() && plane.du.is_finite() && plane.dv.is_finite()).then_some(plane)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_and_planes_agree_with_the_projection() {
        let corners = [DVec3::new(-1.0, 0.2, 0.5), DVec3::new(1.5, 0.0, 0.3), DVec3::new(0.1, 0.4, -2.0)];
        let all = [corners.as_slice(), &[DVec3::new(0.0, 2.0, 0.0)]].concat();
        let views = [
            View::along(DVec3::new(0.3, -1.0, 0.2), &all, &all),
            View::cone(DVec3::new(2.0, 5.0, 1.0), DVec3::ZERO, 50.0, &all),
        ];
        for view in views {
            let place = corners[0] * 0.2 + corners[1] * 0.5 + corners[2] * 0.3;
            let (uv, depth) = view.project(place).expect("in front");
            let plane = view.plane(corners).expect("not edge-on");
            assert!((plane.at(uv.x, uv.y) - depth).abs() < 1e-9, "{} {depth}", plane.at(uv.x, uv.y));
            let (start, direction) = view.ray(uv.x, uv.y);
            let off = (place - start).cross(direction).length();
            assert!(off < 1e-9, "the ray misses by {off}");
            assert!((0.0..=1.0).contains(&depth));
        }
    }

    #[test]
    fn the_square_has_its_origin_at_the_top_left() {
        let camera = Camera { eye: DVec3::new(0.0, 0.0, 5.0), target: DVec3::ZERO, angle: 40.0 };
        let view = camera.view(200, 100);
        let (uv, _) = view.project(DVec3::new(-0.5, 0.7, 0.0)).expect("in front");
        assert!(uv.x < 0.5 && uv.y < 0.5, "{uv}");
    }
}
