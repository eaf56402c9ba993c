#pragma once
/// The one loop over elements. An element kind provides
///
/// - `static constexpr std::string_view name`, `int nodes`, `bool rotations`
/// - `using Settings = ...` if the deck's struct is another: Kind is made from it
/// - `template <class Law> static constexpr bool accepts`
/// - `static constexpr bool uses_differences = true` if absolute positions do as well as relative ones
/// - `static constexpr bool fetches_points_ahead = true` if it asks for the points of the next pack itself
/// - `int points() const`, material points of an element, and `static constexpr int most_points`
/// - `int stations() const` if the points belong to that many cross sections, one after the other, of which
///   each can fail by itself
/// - `static constexpr std::string_view shape_rule` if what is wrong with an element without mass is not its
///   volume
/// - `template <class T, class Law> struct Header`, per element, of lanes T, and `struct Point`, per material
///   point
/// - `NodalMass<T> initialize(const MotionOf<E, T>&, const Law&, Header<T, Law>&, Point<T, Law>*) const`
/// - `Increment<T> force(const MotionOf<E, T>&, T step, const Law&, Header<T, Law>&, Point<T, Law>*,
///   ForcesOf<E, T>&) const`
/// - `ElementSample sample(const MotionOf<E, double>&, const Law&, const Header<double, Law>&, const
///   Point<double, Law>*) const`
///
/// and one .cpp with `choose_kernel` for it. Header and Point hold nothing but numbers `T`, so that a pack is
/// an array [component][lane] and one lane of it can be read back as plain doubles.

#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "elements/base/bad_element.hpp"
#include "elements/block.hpp"
#include "elements/lose.hpp"
#include "elements/scale_mass.hpp"
#include "src/base/fetch_ahead.hpp"
#include "src/base/gather.hpp"

namespace brio {

/// The kernel of a block: the deck's element itself, or a variant of it chosen by its settings.
template <class Kind>
Kind kernel_of(const Element& element) {
  if constexpr (requires { typename Kind::Settings; }) {
    return Kind{std::get<typename Kind::Settings>(element)};
  } else {
    return std::get<Kind>(element);
  }
}

/// The law of a kernel: the deck's material itself, or its reduced form.
template <class Law>
Law law_of(const Material& material) {
  if constexpr (requires { typename Law::Settings; }) {
    return Law{std::get<typename Law::Settings>(material)};
  } else {
    return std::get<Law>(material);
  }
}

/// The law for one step: one that depends on rates is told the step.
template <class Law>
Law law_of(const Material& material, double step) {
  Law law = law_of<Law>(material);
  if constexpr (requires { law.time_step; }) law.time_step = step;
  return law;
}

template <class Kind, class Law, Floating Real>
struct PackLayout {
  using Number = Lanes<Real>;
  using Header = typename Kind::template Header<Number, Law>;
  using Point = typename Kind::template Point<Number, Law>;
  static_assert(sizeof(Header) % sizeof(Number) == 0 && sizeof(Point) % sizeof(Number) == 0);

  static std::size_t bytes(const Kind& kind) {
    return sizeof(Header) + static_cast<std::size_t>(kind.points()) * sizeof(Point);
  }
  static Header& header(Block& block, std::size_t pack) {
    return *reinterpret_cast<Header*>(block.state.data() + pack * block.pack_bytes);
  }
  static Point* points(Block& block, std::size_t pack) {
    return reinterpret_cast<Point*>(block.state.data() + pack * block.pack_bytes + sizeof(Header));
  }
};

/// Positions are made relative to the first node, in double, unless the kernel forms differences itself and
/// nothing is rounded before it does.
template <class Kind, Floating Real>
inline constexpr bool makes_relative = !(sizeof(Real) == 8 && requires { requires Kind::uses_differences; });

template <class Kind, Floating Real>
BRIO_CALLED void gather_motion(const Nodes& nodes, const int* connectivity,
                               MotionOf<Kind, Lanes<Real>>& motion) {
  constexpr int width = lane_count<Real>;
  constexpr std::size_t stride = sizeof(NodeRecord) / sizeof(double);
  const double* position = nodes.record.data()->position;
  const double* velocity = nodes.record.data()->velocity;
  const WideVector<Real> first_position = gather_rows<Real>(position, stride, connectivity);
  const WideVector<Real> first_velocity = gather_rows<Real>(velocity, stride, connectivity);
#pragma GCC unroll 8
  for (int corner = 0; corner < Kind::nodes; ++corner) {
    const int* node = connectivity + corner * width;
    WideVector<Real> x = corner == 0 ? first_position : gather_rows<Real>(position, stride, node);
    WideVector<Real> v = corner == 0 ? first_velocity : gather_rows<Real>(velocity, stride, node);
    if constexpr (makes_relative<Kind, Real>) {
      x = x - first_position;
      v = v - first_velocity;
    }
    motion.position[0][corner] = narrow<Real>(x.x);
    motion.position[1][corner] = narrow<Real>(x.y);
    motion.position[2][corner] = narrow<Real>(x.z);
    motion.velocity[0][corner] = narrow<Real>(v.x);
    motion.velocity[1][corner] = narrow<Real>(v.y);
    motion.velocity[2][corner] = narrow<Real>(v.z);
    if constexpr (Kind::rotations) {
      const WideVector<Real> w = gather_rows<Real>(nodes.angular_velocity.data()->component,
                                                   sizeof(NodeVector) / sizeof(double), node);
      motion.angular_velocity[0][corner] = narrow<Real>(w.x);
      motion.angular_velocity[1][corner] = narrow<Real>(w.y);
      motion.angular_velocity[2][corner] = narrow<Real>(w.z);
    }
  }
}

template <class Kind, Floating Real>
BRIO_CALLED void scatter(Nodes& nodes, const int* connectivity, const ForcesOf<Kind, Lanes<Real>>& forces) {
#pragma GCC unroll 8
  for (int corner = 0; corner < Kind::nodes; ++corner) {
    const int* node = connectivity + corner * lane_count<Real>;
    subtract_from_rows<Real>(nodes.force.data(), node, forces.force[0][corner], forces.force[1][corner],
                             forces.force[2][corner]);
    if constexpr (Kind::rotations)
      subtract_from_rows<Real>(nodes.moment.data(), node, forces.moment[0][corner], forces.moment[1][corner],
                               forces.moment[2][corner]);
  }
}

/// The first `count` lanes of the last pack of a chunk: kept out of the loop, where it would be the larger
/// part of the code.
template <class Kind, Floating Real>
BRIO_CALLED void scatter_first(Nodes& nodes, const int* connectivity, int count,
                               const ForcesOf<Kind, Lanes<Real>>& forces) {
  for (int corner = 0; corner < Kind::nodes; ++corner)
    for (int lane = 0; lane < count; ++lane) {
      const auto node = static_cast<std::size_t>(connectivity[corner * lane_count<Real> + lane]);
      for (int i = 0; i < 3; ++i) {
        nodes.force[node].component[i] -= static_cast<double>(forces.force[i][corner][lane]);
        if constexpr (Kind::rotations)
          nodes.moment[node].component[i] -= static_cast<double>(forces.moment[i][corner][lane]);
      }
    }
}

/// Sum in double, lane by lane, over the packs of a chunk.
template <Floating Real>
struct LaneSum {
  Row8 total[lane_count<Real> / 8] = {};

  BRIO_INLINE void add(Lanes<Real> value, int count) {
    if (count < lane_count<Real>)
      for (int lane = count; lane < lane_count<Real>; ++lane) value.set(lane, Real(0));
    Row8 wide[lane_count<Real> / 8];
    widen(value, wide);
    for (int group = 0; group < lane_count<Real> / 8; ++group) total[group] += wide[group];
  }
  double sum() const {
    double result = 0;
    for (const Row8& group : total)
      for (int lane = 0; lane < 8; ++lane) result += group[lane];
    return result;
  }
};

/// Asks for a half of the state of the pack that comes next: a pack is more work than the processor looks
/// ahead. In halves, before and after the element's forces, because all at once they would wait for each
/// other; a kind with many points asks for those itself, as it comes to them.
enum class StateHalf { first, second };
template <StateHalf half, class Layout, class Kind>
BRIO_INLINE void fetch_next_state(const Block& block, const Kind& kind, std::size_t pack) {
  const auto next = reinterpret_cast<std::uintptr_t>(block.state.data()) + (pack + 1) * block.pack_bytes;
  if constexpr (requires { requires Kind::fetches_points_ahead; }) {
    if (half == StateHalf::first) fetch_ahead(next, sizeof(typename Layout::Header));
  } else {
    const std::size_t first = Layout::bytes(kind) / (2 * cache_line) * cache_line;
    if (half == StateHalf::first) {
      fetch_ahead(next, first);
    } else {
      fetch_ahead(next + first, Layout::bytes(kind) - first);
    }
  }
}

/// Keeps the smallest of the first `count` lanes, and where it is.
template <Floating Real>
BRIO_INLINE void note_stable_step(Lanes<Real> stable_step, std::size_t pack, int count, SweepResult& result) {
  // Not "any smaller": a step that is not a number must count as the smallest of all.
  if (all(stable_step >= Lanes<Real>(result.stable_step))) return;
  for (int lane = 0; lane < count; ++lane) {
    const double candidate = static_cast<double>(stable_step[lane]);
    if (candidate >= result.stable_step || result.stable_step <= 0) continue;
    result.stable_step = std::isnan(candidate) ? -1.0 : candidate;
    result.critical_element = pack * lane_count<Real> + static_cast<std::size_t>(lane);
  }
}

template <class Kind, class Law, Floating Real>
SweepResult sweep_chunk(Block& block, Chunk chunk, Nodes& nodes, double step) {
  using T = Lanes<Real>;
  using Layout = PackLayout<Kind, Law, Real>;
  constexpr int width = lane_count<Real>;
  // Copies that nothing else can alias, so that what depends on parameters alone leaves the loop.
  const Kind kind = kernel_of<Kind>(block.element);
  const Law law = law_of<Law>(block.material, step);
  LaneSum<Real> internal_energy, hourglass_energy, viscous_energy;
  SweepResult result;
  result.stable_step = HUGE_VAL;
  for (std::size_t done = 0; done < chunk.element_count; done += width) {
    const std::size_t pack = chunk.first_pack + done / width;
    const int* connectivity =
        block.connectivity.data() + pack * static_cast<std::size_t>(Kind::nodes * width);
    const int count = static_cast<int>(std::min<std::size_t>(width, chunk.element_count - done));
    MotionOf<Kind, T> motion;
    gather_motion<Kind, Real>(nodes, connectivity, motion);
    fetch_next_state<StateHalf::first, Layout>(block, kind, pack);
    ForcesOf<Kind, T> forces;
    Increment<T> increment =
        kind.force(motion, T(step), law, Layout::header(block, pack), Layout::points(block, pack), forces);
    fetch_next_state<StateHalf::second, Layout>(block, kind, pack);
    if (block.loses_elements) {
      const LostLanes<Real> lost =
          lost_lanes<Kind, Law, Real>(kind, law, block.deletion, Layout::header(block, pack),
                                      Layout::points(block, pack), motion, increment.stable_step);
      if (any(lost.any)) {
        take_back<Kind, Real>(lost.any, motion, step, forces, increment);
        list_lost<Real>(lost, count, chunk.first_pack * width, pack * width, block, result);
      }
      hold<Real>(increment, block.held.data() + pack * 2 * width);
    }
    if (block.scaled_step > 0)
      scale_mass<Real>(block, chunk, pack, count, Layout::header(block, pack), increment.stable_step, result);
    if (count == width) {
      scatter<Kind, Real>(nodes, connectivity, forces);
    } else {
      scatter_first<Kind, Real>(nodes, connectivity, count, forces);
    }
    internal_energy.add(increment.internal_energy, count);
    hourglass_energy.add(increment.hourglass_energy, count);
    viscous_energy.add(increment.viscous_energy, count);
    note_stable_step<Real>(increment.stable_step, pack, count, result);
  }
  result.internal_energy = internal_energy.sum();
  result.hourglass_energy = hourglass_energy.sum();
  result.viscous_energy = viscous_energy.sum();
  return result;
}

/// Edge length of what a material point stands for: of its share of the volume in solids, of the area in
/// shells, of the length in beams.
template <class Kind, Floating Real>
Lanes<Real> point_size(const Kind& kind, Lanes<Real> nodal_mass, double density) {
  Lanes<Real> size;
  for (int lane = 0; lane < lane_count<Real>; ++lane) {
    const double volume = Kind::nodes * static_cast<double>(nodal_mass[lane]) / density;
    if constexpr (requires { kind.point_length(volume); }) {
      size.set(lane, static_cast<Real>(kind.point_length(volume)));
    } else if constexpr (requires { kind.thickness; }) {
      size.set(lane, static_cast<Real>(std::sqrt(volume / kind.thickness)));
    } else {
      size.set(lane, static_cast<Real>(std::cbrt(volume / kind.points())));
    }
  }
  return size;
}

template <class Kind, class Law, Floating Real>
void initialize_block(Block& block, Nodes& nodes) {
  using T = Lanes<Real>;
  using Layout = PackLayout<Kind, Law, Real>;
  constexpr int width = lane_count<Real>;
  const Kind kind = kernel_of<Kind>(block.element);
  const Law law = law_of<Law>(block.material);
  for (std::size_t pack = 0; pack < block.pack_count; ++pack) {
    const int* connectivity =
        block.connectivity.data() + pack * static_cast<std::size_t>(Kind::nodes * width);
    MotionOf<Kind, T> motion;
    gather_motion<Kind, Real>(nodes, connectivity, motion);
    const NodalMass<T> share =
        kind.initialize(motion, law, Layout::header(block, pack), Layout::points(block, pack));
    for (int lane = 0; lane < width && pack * width + static_cast<std::size_t>(lane) < block.element_count;
         ++lane) {
      if (!(share.mass[lane] > 0)) {
        std::string rule = "has no positive volume";
        if constexpr (requires { Kind::shape_rule; }) rule = Kind::shape_rule;
        throw BadElement(pack * width + static_cast<std::size_t>(lane), rule);
      }
      for (int corner = 0; corner < Kind::nodes; ++corner) {
        const auto node = static_cast<std::size_t>(connectivity[corner * width + lane]);
        nodes.mass[node] += static_cast<double>(share.mass[lane]);
        if constexpr (Kind::rotations)
          nodes.rotational_inertia[node] += static_cast<double>(share.rotational_inertia[lane]);
      }
    }
    if constexpr (requires { law.start(Layout::points(block, pack)->history, share.mass); }) {
      const T size = point_size<Kind, Real>(kind, share.mass, law.density);
      for (int p = 0; p < kind.points(); ++p) law.start(Layout::points(block, pack)[p].history, size);
    }
  }
}

/// One lane of a pack as plain doubles.
template <class Scalar, Floating Real>
void copy_lane(const std::byte* pack, int lane, Scalar* out) {
  static_assert(std::is_trivially_copyable_v<Scalar>);
  for (std::size_t component = 0; component < sizeof(Scalar) / sizeof(double); ++component) {
    Real value;
    std::memcpy(&value, pack + (component * lane_count<Real> + static_cast<std::size_t>(lane)) * sizeof(Real),
                sizeof value);
    const auto widened = static_cast<double>(value);
    std::memcpy(reinterpret_cast<std::byte*>(out) + component * sizeof(double), &widened, sizeof widened);
  }
}

template <class Kind, class Law, Floating Real>
ElementSample sample_element(const Block& block, const Nodes& nodes, std::size_t e) {
  using Layout = PackLayout<Kind, Law, Real>;
  constexpr int width = lane_count<Real>;
  const Kind kind = kernel_of<Kind>(block.element);
  const std::byte* pack = block.state.data() + (e / width) * block.pack_bytes;
  const int lane = static_cast<int>(e % width);
  typename Kind::template Header<double, Law> header;
  copy_lane<decltype(header), Real>(pack, lane, &header);
  std::array<typename Kind::template Point<double, Law>, Kind::most_points> points;
  const auto count = static_cast<std::size_t>(kind.points());
  for (std::size_t p = 0; p < count; ++p)
    copy_lane<typename Kind::template Point<double, Law>, Real>(
        pack + sizeof(typename Layout::Header) + p * sizeof(typename Layout::Point), lane, &points[p]);
  MotionOf<Kind, double> motion;
  const NodeRecord& first = nodes.record[static_cast<std::size_t>(block.node(e, 0))];
  for (int corner = 0; corner < Kind::nodes; ++corner) {
    const auto node = static_cast<std::size_t>(block.node(e, corner));
    for (int i = 0; i < 3; ++i) {
      motion.position[i][corner] = nodes.record[node].position[i] - first.position[i];
      motion.velocity[i][corner] = nodes.record[node].velocity[i] - first.velocity[i];
      if constexpr (Kind::rotations)
        motion.angular_velocity[i][corner] = nodes.angular_velocity[node].component[i];
    }
  }
  ElementSample sample = kind.sample(motion, law_of<Law>(block.material), header, points.data());
  if constexpr (can_fail<Law>)
    for (std::size_t p = 0; p < count; ++p) sample.damage = std::max(sample.damage, points[p].history.damage);
  return sample;
}

template <class Kind, class Law, Floating Real>
double mass_of_element(const Block& block, std::size_t e) {
  typename Kind::template Header<double, Law> header;
  copy_lane<decltype(header), Real>(block.state.data() + (e / lane_count<Real>)*block.pack_bytes,
                                    static_cast<int>(e % lane_count<Real>), &header);
  return header.mass;
}

template <class Kind, class Law, Floating Real>
double gyration_of_element(const Block& block, std::size_t e) {
  if constexpr (Kind::rotations) {
    typename Kind::template Header<double, Law> header;
    copy_lane<decltype(header), Real>(block.state.data() + (e / lane_count<Real>)*block.pack_bytes,
                                      static_cast<int>(e % lane_count<Real>), &header);
    return kernel_of<Kind>(block.element).gyration_of(header);
  } else {
    return 0;
  }
}

template <class Kind, class Law, Floating Real>
void set_kernel(Block& block) {
  block.pack_bytes = PackLayout<Kind, Law, Real>::bytes(kernel_of<Kind>(block.element));
  block.kernel = {sweep_chunk<Kind, Law, Real>,         initialize_block<Kind, Law, Real>,
                  sample_element<Kind, Law, Real>,      mass_of_element<Kind, Law, Real>,
                  gyration_of_element<Kind, Law, Real>, nullptr};
  block.loses_elements = can_fail<Law> || block.deletion.names_a_criterion();
}

/// Whatever precision the deck asks for.
template <class Kind>
constexpr bool is_always_double = requires {
  requires Kind::always_double;
};

template <class Kind, class Law>
void set_kernel(Block& block) {
  if constexpr (!is_always_double<Kind>)
    if (block.precision == Precision::single_precision) return set_kernel<Kind, Law, float>(block);
  set_kernel<Kind, Law, double>(block);
}

/// \param settings what the deck says; a law that fails is another type than one that does not.
template <class Kind, class Law, class Settings>
void set_kernel_with_failure(const Settings& settings, Block& block) {
  if constexpr (requires { settings.failure; }) {
    if (settings.failure) {
      set_kernel<Kind, Failing<Law>>(block);
      return;
    }
  }
  set_kernel<Kind, Law>(block);
}

/// Sets block.kernel and block.pack_bytes; instantiates every accepted law in the precisions of the
/// kind. Compiled in one source a kind.
template <class Kind>
void choose_kernel_of(Block& block) {
  std::visit(
      [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        if constexpr (!Kind::template accepts<Law>) {
          throw std::invalid_argument("material model '" + std::string(Law::name) +
                                      "' cannot be used by element '" + std::string(Kind::name) +
                                      "' with these settings");
        } else if constexpr (requires { typename Law::Reduced; }) {
          if (law.is_reduced()) {
            set_kernel_with_failure<Kind, typename Law::Reduced>(law, block);
          } else {
            set_kernel_with_failure<Kind, Law>(law, block);
          }
        } else {
          set_kernel_with_failure<Kind, Law>(law, block);
        }
      },
      block.material);
}

// One source holds the code of the kernels of an element kind and objective rate.
void choose_kernel(const Hex8&, Block& block);
void choose_kernel(const Shell4&, Block& block);
void choose_kernel(const Hex8Full&, Block& block);
void choose_kernel(const Beam2&, Block& block);
void choose_kernel(const Particle&, Block& block);
inline void choose_kernel(const Rigid&, Block&) {}  // nothing is swept

}  // namespace brio
