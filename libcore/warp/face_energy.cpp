// Sources: Smith, Schaefer, "Bijective Parameterization with Free Boundaries", SIGGRAPH 2015 (energy, largest
// step); Garanzha et al., "Foldover-free maps in 50 lines of code", SIGGRAPH 2021 (untangling); Liu et al.,
// "A Local/Global Approach to Mesh Parameterization", SGP 2008 (nearest rotation of each face).
#include "libcore/warp/face_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace imgmesh {
namespace {

// With coefficients [a b; c d]. Only +, -, *, / and the square root are used, which round alike everywhere.
struct Map {
    double a, b, c, d;

    double determinant() const { return a * d - b * c; }
    double squares() const { return (a * a + b * b) + (c * c + d * d); }
};

struct Value {
    double energy;
    Map slope;  // by the coefficients
};

Value rigid(const Map& j) {
    double cosine = j.a + j.d, sine = j.c - j.b;
    const double length = std::sqrt(cosine * cosine + sine * sine);
    cosine = length > 0 ? cosine / length : 1;
    sine = length > 0 ? sine / length : 0;
    const Map off{j.a - cosine, j.b + sine, j.c - sine, j.d - cosine};
    return {off.squares(), {2 * off.a, 2 * off.b, 2 * off.c, 2 * off.d}};
}

// The slope of by_square * |J|^2 + by_determinant * det J.
Map slope_of(const Map& j, double by_square, double by_determinant) {
    const double s = 2 * by_square, t = by_determinant;
    return {s * j.a + t * j.d, s * j.b - t * j.c, s * j.c - t * j.b, s * j.d + t * j.a};
}

double smooth_positive(double d, double root, double smoothing) {
    // The sum would cancel for negative d.
    return d > 0 ? (d + root) / 2 : smoothing * smoothing / (2 * (root - d));
}

Value untangle(const Map& j, double smoothing) {
    const double d = j.determinant(), root = std::sqrt(d * d + smoothing * smoothing);
    const double chi = smooth_positive(d, root, smoothing);
    const double inverse = 1 / chi, energy = (j.squares() + d * d + 1) * inverse;
    return {energy, slope_of(j, inverse, 2 * d * inverse - energy / root)};
}

Value barrier(const Map& j) {
    const double d = j.determinant();
    if (!(d > 0)) return {std::numeric_limits<double>::infinity(), {}};
    const double inverse = 1 / d, factor = 1 + inverse * inverse, squares = j.squares();
    return {squares * factor, slope_of(j, factor, -2 * squares * inverse * inverse * inverse)};
}

Value value_of(const EnergyKind& kind, const Map& j) {
    switch (kind.form) {
        case EnergyKind::Form::kRigid:
            return rigid(j);
        case EnergyKind::Form::kUntangle:
            return untangle(j, kind.smoothing);
        case EnergyKind::Form::kBarrier:
            break;
    }
    return barrier(j);
}

Map map_of(const Face& corner, const Vec2d& p, const Vec2d& q, std::span<const Vec2d> place) {
    const Vec2d &at = place[corner[0]], ab = place[corner[1]] - at, ac = place[corner[2]] - at;
    return {ab.x() * p.x() + ac.x() * q.x(), ab.x() * p.y() + ac.x() * q.y(), ab.y() * p.x() + ac.y() * q.x(),
            ab.y() * p.y() + ac.y() * q.y()};
}

// Of an energy of |J|^2 and d = det J that is linear in the former.
struct Derivatives {
    double by_square, by_determinant, mixed, twice;
};

Derivatives derivatives(const EnergyKind& kind, const Map& j) {
    const double d = j.determinant(), squares = j.squares();
    if (kind.form == EnergyKind::Form::kBarrier) {
        const double inverse = 1 / d, cube = inverse * inverse * inverse;
        return {1 + inverse * inverse, -2 * squares * cube, -2 * cube, 6 * squares * cube * inverse};
    }
    const double root = std::sqrt(d * d + kind.smoothing * kind.smoothing),
                 chi = smooth_positive(d, root, kind.smoothing);
    const double sum = squares + d * d + 1, slope = 1 / (chi * root);
    return {1 / chi, 2 * d / chi - sum * slope, -slope,
            2 / chi - 4 * d * slope + sum * slope * (1 + d / root) / root};
}

double cross(const Vec2d& a, const Vec2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

// The least root in (0, 1] of c + b s + a s^2, with c > 0; infinity if there is none.
double first_root(double a, double b, double c) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    if (c + std::min(b, 0.0) + std::min(a, 0.0) > 0) return kNever;
    const double square = b * b - 4 * a * c;
    if (square < 0) return kNever;
    // The two quotients are the roots, computed without cancellation.
    const double q = -0.5 * (b + (b < 0 ? -1 : 1) * std::sqrt(square));
    double least = kNever;
    for (const double root : {q / a, c / q})
        if (root > 0 && root < least) least = root;
    return least <= 1 ? least : kNever;
}

}  // namespace

FaceEnergies::FaceEnergies(const BaseMesh& mesh, const std::vector<bool>& is_used) {
    for (const Face& face : mesh.faces) {
        if (!is_used[face[0]]) continue;
        const Vec2d a = mesh.position[face[0]].cast<double>();
        const Vec2d ab = mesh.position[face[1]].cast<double>() - a,
                    ac = mesh.position[face[2]].cast<double>() - a;
        const double twice = -cross(ab, ac);  // y grows down
        if (!(twice > 0)) continue;
        faces_.push_back({face, 0.5 * twice, Vec2d(-ac.y(), ac.x()) / twice, Vec2d(ab.y(), -ab.x()) / twice});
    }
}

double FaceEnergies::evaluate(const EnergyKind& kind, std::span<const Vec2d> place,
                              std::span<Vec2d> gradient) const {
    std::fill(gradient.begin(), gradient.end(), Vec2d(0, 0));
    double sum = 0;
    for (const RestFace& f : faces_) {
        const Value v = value_of(kind, map_of(f.corner, f.p, f.q, place));
        sum += f.area * v.energy;
        const Vec2d b = f.area * Vec2d(v.slope.a * f.p.x() + v.slope.b * f.p.y(),
                                       v.slope.c * f.p.x() + v.slope.d * f.p.y());
        const Vec2d c = f.area * Vec2d(v.slope.a * f.q.x() + v.slope.b * f.q.y(),
                                       v.slope.c * f.q.x() + v.slope.d * f.q.y());
        gradient[f.corner[0]] -= b + c;
        gradient[f.corner[1]] += b;
        gradient[f.corner[2]] += c;
    }
    return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

// In the plane, J is the sum of a similarity S and a reflected one T, and an energy f(|J|^2, det J), linear
// in |J|^2, has the Hessian's eigenvectors S and T turned by a right angle, and two in the plane of S and T.
std::array<std::array<double, 4>, 4> FaceEnergies::map_hessian(const EnergyKind& kind, const RestFace& face,
                                                               std::span<const Vec2d> place) {
    const Map j = map_of(face.corner, face.p, face.q, place);
    const Derivatives f = derivatives(kind, j);
    const double s0 = 0.5 * (j.a + j.d), s1 = 0.5 * (j.b - j.c), t0 = 0.5 * (j.a - j.d),
                 t1 = 0.5 * (j.b + j.c);
    const double s = std::sqrt(2 * (s0 * s0 + s1 * s1)), t = std::sqrt(2 * (t0 * t0 + t1 * t1));
    using Direction = std::array<double, 4>;
    const double root = std::sqrt(0.5);
    const Direction along_s =
        s > 0 ? Direction{s0 / s, s1 / s, -s1 / s, s0 / s} : Direction{root, 0, 0, root};
    const Direction along_t =
        t > 0 ? Direction{t0 / t, t1 / t, t1 / t, -t0 / t} : Direction{root, 0, 0, -root};
    const Direction across_s = {-along_s[1], along_s[0], -along_s[0], -along_s[1]};
    const Direction across_t = {-along_t[1], along_t[0], along_t[0], along_t[1]};
    const double ss = 2 * f.by_square + f.by_determinant + s * s * (4 * f.mixed + f.twice),
                 tt = 2 * f.by_square - f.by_determinant + t * t * (f.twice - 4 * f.mixed),
                 st = -s * t * f.twice;
    // The eigenvalues of [ss st; st tt], and the angle of their eigenvectors by its cosine and sine.
    const double half = 0.5 * (ss - tt), radius = std::sqrt(half * half + st * st);
    const double mean = 0.5 * (ss + tt);
    const double cosine = radius > 0 ? std::sqrt(std::max(0.0, 0.5 * (1 + half / radius))) : 1;
    const double sine =
        radius > 0 ? (st < 0 ? -1 : 1) * std::sqrt(std::max(0.0, 0.5 * (1 - half / radius))) : 0;
    std::array<std::array<double, 4>, 4> sum{};
    const auto add = [&](double value, const Direction& v) {
        if (!(value > 0)) return;
        for (std::size_t r = 0; r < 4; ++r)
            for (std::size_t c = 0; c < 4; ++c) sum[r][c] += face.area * value * v[r] * v[c];
    };
    Direction first, second;
    for (std::size_t k = 0; k < 4; ++k) {
        first[k] = cosine * along_s[k] + sine * along_t[k];
        second[k] = cosine * along_t[k] - sine * along_s[k];
    }
    add(mean + radius, first);
    add(mean - radius, second);
    add(2 * f.by_square + f.by_determinant, across_s);
    add(2 * f.by_square - f.by_determinant, across_t);
    return sum;
}

double FaceEnergies::least_determinant(std::span<const Vec2d> place) const {
    double least = 1;
    for (const RestFace& f : faces_) {
        const Vec2d& at = place[f.corner[0]];
        const double twice = cross(place[f.corner[2]] - at, place[f.corner[1]] - at);
        least = std::min(least, twice / (2 * f.area));
    }
    return least;
}

double FaceEnergies::largest_step(std::span<const Vec2d> place, std::span<const Vec2d> move) const {
    double least = 1;
    for (const RestFace& f : faces_) {
        const auto [a, b, c] = f.corner;
        const Vec2d p = place[c] - place[a], q = place[b] - place[a];
        const Vec2d dp = move[c] - move[a], dq = move[b] - move[a];
        least = std::min(least, first_root(cross(dp, dq), cross(p, dq) + cross(dp, q), cross(p, q)));
    }
    return least;
}

}  // namespace imgmesh
