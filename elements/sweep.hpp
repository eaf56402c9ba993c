#pragma once
/// The one loop over elements, for any kernel and law (elements/base/element_kind.hpp,
/// materials/material_law.hpp), and the choice of the kernel of a block.

#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "elements/base/bad_element.hpp"
#include "elements/block.hpp"
#include "elements/lose.hpp"
#include "elements/nodal_stiffness.hpp"
#include "elements/node_exchange.hpp"
#include "elements/scale_mass.hpp"
#include "elements/stiffness_product.hpp"
#include "src/base/fetch_ahead.hpp"
#include "src/base/index.hpp"

namespace brio {

/// The kernel of a block, made of the settings of its element.
template <class Kind>
Kind kernel_of(const Element& element) {
  return Kind{std::get<typename Kind::Settings>(element)};
}

/// The law of a kernel: the deck's material itself, its reduced form, or that with failure.
template <class Law>
Law law_of(const Material& material) {
  return Law{std::get<typename Law::Settings>(material)};
}

/// The law for one step: one that depends on rates is told the step.
template <class Law>
Law law_of(const Material& material, double step) {
  Law law = law_of<Law>(material);
  if constexpr (Law::traits.time_step) law.time_step = step;
  return law;
}

template <class Kind, class Law, Floating Real>
struct PackLayout {
  using Number = Lanes<Real>;
  using Header = typename Kind::template Header<Number, Law>;
  using Point = typename Kind::template Point<Number, Law>;
  static_assert(sizeof(Header) % sizeof(Number) == 0 && sizeof(Point) % sizeof(Number) == 0);

  static std::size_t bytes(const Kind& kind) { return sizeof(Header) + index(kind.points()) * sizeof(Point); }
  static Header& header(Block& block, std::size_t pack) {
    return *reinterpret_cast<Header*>(block.state.data() + pack * block.pack_bytes);
  }
  static Point* points(Block& block, std::size_t pack) {
    return reinterpret_cast<Point*>(block.state.data() + pack * block.pack_bytes + sizeof(Header));
  }
};

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
  if constexpr (Kind::kernel_traits.fetches_points_ahead) {
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
    result.critical_element = pack * lane_count<Real> + index(lane);
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
  NodeExchange<Kind, Real> exchange(block, nodes, step);
  LaneSum<Real> internal_energy, hourglass_energy, viscous_energy;
  SweepResult result;
  result.stable_step = HUGE_VAL;
  T damping(0.0), strain_rate_squared(0.0);
  for (std::size_t done = 0; done < chunk.element_count; done += width) {
    const std::size_t pack = chunk.first_pack + done / width;
    const int* connectivity = block.connectivity.data() + pack * index(Kind::nodes * width);
    const int count = static_cast<int>(std::min<std::size_t>(width, chunk.element_count - done));
    MotionOf<Kind, T> motion;
    exchange.gather(connectivity, count, motion);
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
        exchange.take_back(lost.any, motion, forces, increment);
        list_lost<Real>(lost, count, chunk.first_pack * width, pack * width, block, result);
      }
      hold<Real>(increment, block.held.data() + pack * 2 * width);
    }
    if (block.scaled_step > 0)
      scale_mass<Real>(block, chunk, pack, count, Layout::header(block, pack), increment, result);
    if constexpr (Kind::kernel_traits.tangent)
      strain_rate_squared = max(strain_rate_squared, increment.strain_rate_squared);
    if constexpr (Kind::kernel_traits.bounded_alone)
      damping = max(damping, give_stiffness(kind, Layout::header(block, pack), step, increment, forces));
    exchange.scatter(connectivity, count, Layout::header(block, pack), forces);
    internal_energy.add(increment.internal_energy, count);
    hourglass_energy.add(increment.hourglass_energy, count);
    viscous_energy.add(increment.viscous_energy, count);
    note_stable_step<Real>(increment.stable_step, pack, count, result);
  }
  result.internal_energy = internal_energy.sum();
  result.hourglass_energy = hourglass_energy.sum();
  result.viscous_energy = viscous_energy.sum();
  for (int lane = 0; lane < width; ++lane) {
    result.damping = std::max(result.damping, static_cast<double>(damping[lane]));
    result.strain_rate_squared =
        std::max(result.strain_rate_squared, static_cast<double>(strain_rate_squared[lane]));
  }
  return result;
}

/// Edge length of what a material point stands for: of its share of the volume in solids, of the area in
/// shells, of the length in beams.
template <class Kind, Floating Real>
Lanes<Real> point_size(const Kind& kind, const NodeExchange<Kind, Real>& exchange, const int* connectivity,
                       Lanes<Real> nodal_mass, double density) {
  Lanes<Real> size;
  for (int lane = 0; lane < lane_count<Real>; ++lane) {
    const double volume = exchange.volume(connectivity, lane, static_cast<double>(nodal_mass[lane]), density);
    size.set(lane, static_cast<Real>(kind.point_size(volume)));
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
  NodeExchange<Kind, Real> exchange(block, nodes, 0);
  for (std::size_t pack = 0; pack < block.pack_count; ++pack) {
    const int* connectivity = block.connectivity.data() + pack * index(Kind::nodes * width);
    MotionOf<Kind, T> motion;
    exchange.gather_start(connectivity, motion);
    const NodalMass<T> share =
        kind.initialize(motion, law, Layout::header(block, pack), Layout::points(block, pack));
    for (int lane = 0; lane < width && pack * width + index(lane) < block.element_count; ++lane) {
      if (!(share.mass[lane] > 0))
        throw BadElement(pack * width + index(lane), std::string(Kind::kernel_traits.shape_rule));
      for (int corner = 0; corner < Kind::nodes; ++corner) {
        const auto node = index(connectivity[corner * width + lane]);
        nodes.mass[node] += static_cast<double>(share.mass[lane]);
        if constexpr (Kind::rotations)
          nodes.rotational_inertia[node] += static_cast<double>(share.rotational_inertia[lane]);
      }
    }
    if constexpr (can_fail<Law>) {
      const T size = point_size<Kind, Real>(kind, exchange, connectivity, share.mass, law.density);
      for (int p = 0; p < kind.points(); ++p) law.start(Layout::points(block, pack)[p].history, size);
    }
  }
  if (block.pack_count > 0)
    exchange.finish_start(kind, law, Layout::points(block, block.pack_count - 1)->history);
}

/// One lane of a pack as plain doubles.
template <class Scalar, Floating Real>
void copy_lane(const std::byte* pack, int lane, Scalar* out) {
  static_assert(std::is_trivially_copyable_v<Scalar>);
  for (std::size_t component = 0; component < sizeof(Scalar) / sizeof(double); ++component) {
    Real value;
    std::memcpy(&value, pack + (component * lane_count<Real> + index(lane)) * sizeof(Real), sizeof value);
    const auto widened = static_cast<double>(value);
    std::memcpy(reinterpret_cast<std::byte*>(out) + component * sizeof(double), &widened, sizeof widened);
  }
}

/// One element as plain doubles; positions and velocities are relative to its first node.
template <class Kind, class Law>
struct ElementCopy {
  typename Kind::template Header<double, Law> header;
  std::array<typename Kind::template Point<double, Law>, Kind::most_points> points;
  NodalMotionOf<Kind, double> motion;
};

template <class Kind, class Law, Floating Real>
BRIO_INLINE void copy_element(const Block& block, const Nodes& nodes, std::size_t e, std::size_t points,
                              ElementCopy<Kind, Law>& copy) {
  using Layout = PackLayout<Kind, Law, Real>;
  constexpr int width = lane_count<Real>;
  const std::byte* pack = block.state.data() + (e / width) * block.pack_bytes;
  const int lane = static_cast<int>(e % width);
  copy_lane<decltype(copy.header), Real>(pack, lane, &copy.header);
  for (std::size_t p = 0; p < points; ++p)
    copy_lane<typename Kind::template Point<double, Law>, Real>(
        pack + sizeof(typename Layout::Header) + p * sizeof(typename Layout::Point), lane, &copy.points[p]);
  NodalMotionOf<Kind, double>& motion = copy.motion;
  const NodeRecord& first = nodes.record[index(block.node(e, 0))];
  for (int corner = 0; corner < Kind::nodes; ++corner) {
    const auto node = index(block.node(e, corner));
    for (int i = 0; i < 3; ++i) {
      motion.position[i][corner] = nodes.record[node].position[i] - first.position[i];
      motion.velocity[i][corner] = nodes.record[node].velocity[i] - first.velocity[i];
      if constexpr (Kind::rotations)
        motion.angular_velocity[i][corner] = nodes.angular_velocity[node].component[i];
    }
  }
}

/// \param in_full with what fields beyond the default ask for
template <class Kind, class Law, Floating Real>
ElementSample sample_element(const Block& block, const Nodes& nodes, std::size_t e, bool in_full) {
  const Kind kind = kernel_of<Kind>(block.element);
  const auto count = index(kind.points());
  ElementCopy<Kind, Law> copy;
  copy_element<Kind, Law, Real>(block, nodes, e, count, copy);
  const Law law = law_of<Law>(block.material);
  ElementSample sample = kind.sample(copy.motion, law, copy.header, copy.points.data());
  if constexpr (Kind::kernel_traits.completes_samples)
    if (in_full) kind.complete(copy.motion, copy.header, copy.points.data(), sample);
  static_assert(history_names<Law>.size() <= ElementSample::most_named);
  sample.history_names = history_names<Law>;
  if constexpr (Law::traits.named_history) {
    std::size_t next = 0;
    Law::named_history()([&](const auto& row) {
      sample.history[next++] = history_value(law, row, copy.points.data(), count);
      if (row.name != "equivalent_plastic_strain" || !Kind::Settings::traits.has_thickness) return;
      for (ElementSample::Layer* layer : {&sample.top, &sample.middle, &sample.bottom})
        if (layer->point != ElementSample::Layer::none)
          layer->plastic_strain = history_value(law, row, &copy.points[layer->point], 1);
    });
  }
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
void multiply_stiffness_of_block(Block& block, Chunk chunk, const Nodes& nodes, const NodalRows& displacement,
                                 const NodalRows& product) {
  multiply_stiffness<Kind, Law, Real, PackLayout<Kind, Law, Real>>(kernel_of<Kind>(block.element),
                                                                   law_of<Law>(block.material), block, chunk,
                                                                   nodes, displacement, product);
}

template <class Kind, class Law, Floating Real>
void set_kernel(Block& block) {
  block.pack_bytes = PackLayout<Kind, Law, Real>::bytes(kernel_of<Kind>(block.element));
  block.kernel = {sweep_chunk<Kind, Law, Real>,         initialize_block<Kind, Law, Real>,
                  sample_element<Kind, Law, Real>,      mass_of_element<Kind, Law, Real>,
                  gyration_of_element<Kind, Law, Real>, nullptr,
                  Kind::kernel_traits.bounded_alone,    nullptr};
  if constexpr (Kind::kernel_traits.tangent)
    block.kernel.multiply_stiffness = multiply_stiffness_of_block<Kind, Law, Real>;
  block.loses_elements = can_fail<Law> || block.deletion.names_a_criterion();
}

template <class Kind, class Law>
void set_kernel(Block& block) {
  check_kernel<Kind, Law>();
  if constexpr (Kind::traits.precision == ElementPrecision::any)
    if (block.precision == Precision::single_precision) return set_kernel<Kind, Law, float>(block);
  set_kernel<Kind, Law, double>(block);
}

/// \param settings what the deck says; a law that fails is another type than one that does not.
template <class Kind, class Law, class Settings>
void set_kernel_with_failure(const Settings& settings, Block& block) {
  if constexpr (Settings::traits.failure) {
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
        } else if constexpr (Law::traits.is_reduced) {
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

}  // namespace brio
