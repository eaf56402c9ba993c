#include "elements/beam/beam_section.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "elements/shell/through_thickness.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr double pi = std::numbers::pi;
constexpr int most_terms = 101;  // odd; terms of the series of a rectangle fall as exp(-n) or n^-5

/// cosh(x) / cosh(end), 0 <= |x| <= end, however large.
double cosh_ratio(double x, double end) {
  const double size = std::abs(x);
  return std::exp(size - end) * (1 + std::exp(-2 * size)) / (1 + std::exp(-2 * end));
}
double sinh_over_cosh(double x, double end) {
  const double size = std::abs(x);
  return std::copysign(std::exp(size - end) * (1 - std::exp(-2 * size)) / (1 + std::exp(-2 * end)), x);
}

/// Shear along the short and the long side, per twist, at a point of a rectangle of half sides a <= b
/// (Timoshenko & Goodier, Theory of Elasticity, art. 109).
std::array<double, 2> shear_of_twist(double a, double b, double along_short, double along_long) {
  double first = 0;
  double second = 2 * along_short;
  double sign = 1;
  for (int n = 1; n <= most_terms; n += 2) {
    const double rate = n * pi / (2 * a);
    const double factor = sign * 16 * a / (pi * pi * n * n);
    first -= factor * sinh_over_cosh(rate * along_long, rate * b) * std::cos(rate * along_short);
    second -= factor * cosh_ratio(rate * along_long, rate * b) * std::sin(rate * along_short);
    sign = -sign;
  }
  return {first, second};
}

struct LinePoint {
  double place, weight;  // place from -1/2 to 1/2, weights add up to 1
};

/// Gauss' rule over each half, which is exact for |z| as well; for two points over the whole.
std::array<LinePoint, 18> line_rule(int count) {
  std::array<LinePoint, 18> points{};
  const bool whole = count == 2;
  const int each = whole ? 2 : count / 2;
  const ThicknessRule& rule = thickness_rule(ThicknessQuadrature::gauss, each);
  for (int k = 0; k < count; ++k) {
    const auto p = index(k % each);
    const double half = k < each ? -0.25 : 0.25;
    points[index(k)] = whole ? LinePoint{rule.place[p], rule.weight[p]}
                             : LinePoint{half + 0.5 * rule.place[p], 0.5 * rule.weight[p]};
  }
  return points;
}

/// Fibres of a rectangle about (0, z0), whose twist is that of the rectangle by itself.
void add_rectangle(FibreSection& section, double width, double height, double z0, int across, int up,
                   double shear_y, double shear_z) {
  const auto columns = line_rule(across);
  const auto rows = line_rule(up);
  const double area = width * height;
  const int first = section.count;
  double sum = 0;
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < up; ++j) {
      const LinePoint& column = columns[index(i)];
      const LinePoint& row = rows[index(j)];
      const double y = width * column.place;
      const double z = height * row.place;
      // (along y, along z) = (-z, y) in a circle; in the series the short side is the first axis.
      std::array<double, 2> twist{};
      if (width <= height) {
        twist = shear_of_twist(width / 2, height / 2, y, z);
      } else {
        const auto [short_side, long_side] = shear_of_twist(height / 2, width / 2, z, y);
        twist = {-long_side, -short_side};
      }
      const double share = column.weight * row.weight * area / section.area;
      sum += share * section.area * (twist[0] * twist[0] + twist[1] * twist[1]);
      section.fibre[index(section.count++)] = {y, z0 + z, share, shear_y, shear_z, twist[0], twist[1]};
    }
  const double scale = std::sqrt(torsion_constant(width, height) / sum);
  for (int f = first; f < section.count; ++f) {
    section.fibre[index(f)].twist_y *= scale;
    section.fibre[index(f)].twist_z *= scale;
  }
  section.torsion_constant += torsion_constant(width, height);
}

FibreSection round_fibres(double inner, double outer, const std::array<int, 2>& fibres) {
  FibreSection section;
  section.area = pi * (outer * outer - inner * inner);
  section.radius = outer;
  // Cowper (1966), for a Poisson's ratio of 0.
  const double ratio = inner / outer;
  const double square = (1 + ratio * ratio) * (1 + ratio * ratio);
  const double shear = std::sqrt(6 * square / (7 * square + 20 * ratio * ratio));
  const ThicknessRule& rule = thickness_rule(ThicknessQuadrature::gauss, fibres[0]);
  const double middle = 0.5 * (inner + outer);
  for (int ring = 0; ring < fibres[0]; ++ring) {
    const auto p = index(ring);
    const double radius = middle + (outer - inner) * rule.place[p];
    for (int k = 0; k < fibres[1]; ++k) {
      const double angle = (2 * k + 1) * pi / fibres[1];
      const double y = radius * std::cos(angle);
      const double z = radius * std::sin(angle);
      section.fibre[index(section.count++)] = {
          y, z, rule.weight[p] * radius / (middle * fibres[1]), shear, shear, -z, y};
    }
  }
  section.torsion_constant = 0.5 * section.area * (outer * outer + inner * inner);
  return section;
}

FibreSection fibres_of(const CircleSection& circle) { return round_fibres(0, circle.radius, circle.fibres); }
FibreSection fibres_of(const TubeSection& tube) {
  return round_fibres(tube.inner_radius, tube.outer_radius, tube.fibres);
}
FibreSection fibres_of(const RectangleSection& rectangle) {
  FibreSection section;
  section.area = rectangle.width * rectangle.height;
  section.radius = std::sqrt(section.area / pi);
  const double shear = std::sqrt(5.0 / 6.0);
  add_rectangle(section, rectangle.width, rectangle.height, 0, rectangle.fibres[0], rectangle.fibres[1],
                shear, shear);
  return section;
}

// Shear along the web is that of the web alone, shear along the flanges that of two rectangles.
FibreSection fibres_of(const ISection& profile) {
  FibreSection section;
  const double web = profile.height - 2 * profile.flange_thickness;
  section.area = 2 * profile.width * profile.flange_thickness + web * profile.web_thickness;
  section.radius = std::sqrt(section.area / pi);
  const auto [along, through] = profile.fibres;
  const double lever = 0.5 * (profile.height - profile.flange_thickness);
  for (const double z0 : {-lever, lever})
    add_rectangle(section, profile.width, profile.flange_thickness, z0, along, through, std::sqrt(5.0 / 6.0),
                  0);
  add_rectangle(section, profile.web_thickness, web, 0, through, along, 0, 1);
  return section;
}

}  // namespace

double torsion_constant(double width, double height) {
  const double a = 0.5 * std::min(width, height);
  const double b = 0.5 * std::max(width, height);
  double sum = 0;
  for (int n = most_terms; n > 0; n -= 2) sum += std::tanh(n * pi * b / (2 * a)) / std::pow(n, 5);
  return 16 * a * a * a * b * (1.0 / 3.0 - 64 * a * sum / (std::pow(pi, 5) * b));
}

FibreSection fibres_of(const BeamSection& shape, double shear_factor) {
  FibreSection section = std::visit([](const auto& one) { return fibres_of(one); }, shape);
  for (int f = 0; f < section.count; ++f) {
    const BeamFibre& fibre = section.fibre[index(f)];
    section.second_moment_y += section.area * fibre.share * fibre.z * fibre.z;
    section.second_moment_z += section.area * fibre.share * fibre.y * fibre.y;
    section.shear_factor_y += fibre.share * fibre.shear_y * fibre.shear_y;
    section.shear_factor_z += fibre.share * fibre.shear_z * fibre.shear_z;
  }
  if (shear_factor > 0) {
    const double scale_y = std::sqrt(shear_factor / section.shear_factor_y);
    const double scale_z = std::sqrt(shear_factor / section.shear_factor_z);
    for (int f = 0; f < section.count; ++f) {
      section.fibre[index(f)].shear_y *= scale_y;
      section.fibre[index(f)].shear_z *= scale_z;
    }
    section.shear_factor_y = section.shear_factor_z = shear_factor;
  }
  return section;
}

}  // namespace brio
