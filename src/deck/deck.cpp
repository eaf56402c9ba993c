#include "src/deck/deck.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "src/base/index.hpp"

namespace brio {

namespace {

// Index of the first point after `time`, in [0, count].
std::size_t next_point(const std::vector<std::array<double, 2>>& points, double time) {
  return index(std::upper_bound(points.begin(), points.end(), time,
                                [](double t, const auto& point) { return t < point[0]; }) -
               points.begin());
}

}  // namespace

Deck::Deck() = default;
Deck::Deck(const Deck&) = default;
Deck::Deck(Deck&&) noexcept = default;
Deck& Deck::operator=(const Deck&) = default;
Deck& Deck::operator=(Deck&&) noexcept = default;
Deck::~Deck() = default;

double WedgeMesh::shoulder() const {
  const double height_of_flanks =
      (thickness - tip_width) / (2 * std::tan(half_angle * std::numbers::pi / 180));
  const bool all_flank = std::abs(height_of_flanks - height) <= 1e-12 * height;  // but for rounding
  return all_flank ? height : height_of_flanks;
}

std::string_view WedgeMesh::fault() const {
  if (tip_width >= thickness) return "the blade has no edge; tip_width must be below thickness";
  if (shoulder() > height)
    return "the flanks do not reach the thickness; a larger height or half_angle, or a smaller thickness is "
           "accepted";
  if (shoulder() < height && elements[1] < 2)
    return "the flanks need elements of their own; at least 2 elements up are accepted";
  return fault_of_size(elements[0], elements[1], elements[2]);
}

std::string_view ParticleMesh::fault() const {
  if (box.has_value() + cylinder.has_value() + sphere.has_value() != 1)
    return "the shape is not said once; accepted is one of box, cylinder and sphere";
  Vector3d cells{};
  double spacing = 0;
  if (box) cells = box->size, spacing = box->spacing;
  if (cylinder) {
    cells = {2 * cylinder->radius, 2 * cylinder->radius, cylinder->height}, spacing = cylinder->spacing;
    if (cylinder->radius - cylinder->inner_radius < spacing)
      return "the wall is thinner than the spacing; a smaller spacing is accepted";
  }
  if (sphere) {
    cells = {2 * sphere->radius, 2 * sphere->radius, 2 * sphere->radius}, spacing = sphere->spacing;
    if (sphere->radius < spacing) return "the radius is below the spacing; a smaller spacing is accepted";
  }
  for (const double cell : cells)
    if (cell < 1.5 * spacing)
      return "there is but one particle along an axis; at least two are accepted, of a smaller spacing";
  std::array<std::int64_t, 3> count{};
  for (std::size_t i = 0; i < 3; ++i)
    count[i] = static_cast<std::int64_t>(std::min(cells[i] / spacing + 2, 0x1p30));
  return fault_of_size(count[0], count[1], count[2]);
}

double Curve::operator()(double time) const {
  if (expression) return expression->at(time);
  const std::size_t next = next_point(points, time);
  if (next == 0) return points.front()[1];
  if (next == points.size()) return points.back()[1];
  const auto& [t0, y0] = points[next - 1];
  const auto& [t1, y1] = points[next];
  return y0 + (y1 - y0) * (time - t0) / (t1 - t0);
}

double Curve::slope(double time) const {
  if (expression) {
    // Errors of truncation and of rounding are both about 1e-12 of the values over the time that is sampled.
    const double h = 1e-3 * (points.back()[0] - points.front()[0]);
    const Expression& f = *expression;
    return (8 * (f.at(time + h) - f.at(time - h)) - (f.at(time + 2 * h) - f.at(time - 2 * h))) / (12 * h);
  }
  const std::size_t next = next_point(points, time);
  if (next == 0 || next == points.size()) return 0;
  return (points[next][1] - points[next - 1][1]) / (points[next][0] - points[next - 1][0]);
}

bool Curve::operator==(const Curve& other) const {
  if (!expression || !other.expression) return !expression && !other.expression && points == other.points;
  return expression->text() == other.expression->text() && points == other.points;
}

double SpaceTimeCurve::at(const Vector3d& position, double time) const {
  return varies_in_space ? expression->at(time, position) : (*this)(time);
}

}  // namespace brio
