#pragma once
/// What a kind of element provides, checked by the compiler: settings, of which a deck sets the entries and
/// the whole program asks what kind it is, and a kernel, its mathematics, which the sweep calls.
///
/// Settings are a plain struct with
///
///     static constexpr std::string_view name;     // its word in a deck
///     static constexpr int nodes;                 // nodes an element; 0: as many as the mesh gives it
///     static constexpr bool rotations;            // whether its nodes turn
///     static constexpr ElementTraits traits;
///     template <class Law> static constexpr bool accepts;     // from the traits of the law
///     static constexpr auto fields();             // entries of a deck (src/base/fields.hpp)
///     double contact_thickness() const;           // length; 0 where its faces are what touches
///     void choose_kernel(const Settings&, Block&);    // beside the struct: sets block.kernel, in a source
///                                                     // of the kind that calls choose_kernel_of (sweep.hpp)
///
/// A kernel is made of the settings and has, besides nodes, rotations and accepts,
///
///     using Settings = ...;
///     static constexpr KernelTraits kernel_traits;
///     static constexpr int most_points;
///     int points() const;                         // material points of an element, up to most_points
///     double point_size(double volume) const;     // edge of what a point stands for, of an element's volume
///     template <class T, class Law> struct Header;    // state of an element: T mass and more
///     template <class T, class Law> struct Point;     // of an integration point: Law::History<T> and more
///     NodalMass<T> initialize(const MotionOf<E, T>&, const Law&, Header<T, Law>&,
///                             Point<T, Law>*) const;
///     Increment<T> force(const MotionOf<E, T>&, T step, const Law&, Header<T, Law>&, Point<T, Law>*,
///                        ForcesOf<E, T>&) const;
///     ElementSample sample(const NodalMotionOf<E, double>&, const Law&, const Header<double, Law>&,
///                          const Point<double, Law>*) const;
///     auto gyration_of(const Header<T, Law>&) const;  // where nodes turn: rotational inertia of a node over
///                                                     // its mass, length squared; of lanes or for all
///
/// Header and Point hold nothing but numbers T, so that a pack is an array [component][lane] and one lane of
/// it can be read back as plain doubles. A kernel that sees more than its own nodes specializes SeenByKernel
/// (motion.hpp) and NodeExchange (elements/node_exchange.hpp).

#include <algorithm>
#include <concepts>
#include <string_view>
#include <variant>
#include <vector>

#include "elements/base/element_sample.hpp"
#include "elements/base/motion.hpp"
#include "materials/material_law.hpp"
#include "src/base/cell_type.hpp"

namespace brio {

/// In which precision a kind is computed.
enum class ElementPrecision {
  any,            ///< as the deck says
  always_double,  ///< whatever the deck says
  double_only     ///< a deck that says single precision is refused
};

/// What the program asks of a kind.
struct ElementTraits {
  CellType cell;
  /// Under which its elements are counted in the summary of a run; kinds may share one.
  std::string_view summary_key{};
  ElementPrecision precision = ElementPrecision::any;
  /// Elements can be given mass for a longer stable time step.
  bool gains_mass = true;
  /// Nodes can be those of other parts as well.
  bool shares_nodes = true;
  // What its samples tell beside stress and energy.
  bool has_thickness = false;
  bool has_radius = false;
  bool has_density = false;
  bool has_section = false;
  bool has_hourglass_control = false;
};

/// What the sweep asks of a kernel.
struct KernelTraits {
  /// Absolute positions do as well as relative ones.
  bool uses_differences = false;
  /// It asks for the points of the next pack itself, as it comes to them.
  bool fetches_points_ahead = false;
  /// stations(): cross sections to which the points belong, one after the other, and each of which can fail
  /// by itself.
  bool stations = false;
  /// Its bounds are those of an element by itself with the mass that it gives to its nodes.
  bool bounded_alone = true;
  /// undamped(), start_unstressed(now, header, point): its elastic stiffness can be multiplied with
  /// displacements (elements/stiffness_product.hpp).
  bool tangent = false;
  /// complete(motion, header, point, sample): what fields beyond the default ask of a sample.
  bool completes_samples = false;
  /// What is wrong with an element without mass.
  std::string_view shape_rule = "has no positive volume";
};

template <class Kind>
concept ElementSettings = requires(const Kind& kind) {
  requires std::same_as<decltype(Kind::traits), const ElementTraits>;
  { Kind::name } -> std::convertible_to<std::string_view>;
  { Kind::nodes } -> std::same_as<const int&>;
  { Kind::rotations } -> std::same_as<const bool&>;
  { kind.contact_thickness() } -> std::same_as<double>;
  Kind::fields();
};

/// Whether a kernel has stations().
template <class Kernel>
concept HasStations = requires(const Kernel& kernel) {
  { kernel.stations() } -> std::same_as<int>;
};

/// Members that the sweep calls; of lanes that are one double. Said of a kernel as the deck's settings make
/// it, and of a law that it accepts.
template <class Kernel, class Law>
concept HasKernelMembers = requires(const Kernel& kernel, const Law& law,
                                    const MotionOf<Kernel, double>& motion,
                                    const NodalMotionOf<Kernel, double>& nodal_motion,
                                    typename Kernel::template Header<double, Law>& header,
                                    const typename Kernel::template Header<double, Law>& kept,
                                    typename Kernel::template Point<double, Law>* point,
                                    const typename Kernel::template Point<double, Law>* kept_point,
                                    ForcesOf<Kernel, double>& forces) {
  requires std::same_as<decltype(Kernel::kernel_traits), const KernelTraits>;
  requires ElementSettings<typename Kernel::Settings>;
  { Kernel::most_points } -> std::same_as<const int&>;
  { kernel.points() } -> std::same_as<int>;
  { kernel.point_size(1.0) } -> std::same_as<double>;
  { header.mass } -> std::same_as<double&>;
  { point->history } -> std::same_as<typename Law::template History<double>&>;
  { kernel.initialize(motion, law, header, point) } -> std::same_as<NodalMass<double>>;
  { kernel.force(motion, 1.0, law, header, point, forces) } -> std::same_as<Increment<double>>;
  { kernel.sample(nodal_motion, law, kept, kept_point) } -> std::same_as<ElementSample>;
};

template <class Kernel, class Law>
concept HasGyration = !Kernel::rotations ||
                      requires(const Kernel& kernel, const typename Kernel::template Header<double, Law>& h) {
  { kernel.gyration_of(h) } -> std::same_as<double>;
};

template <class Kernel>
inline constexpr bool announces_its_stations = Kernel::kernel_traits.stations == HasStations<Kernel>;

template <class Kernel, class Law>
concept HasComplete = requires(const Kernel& kernel, const NodalMotionOf<Kernel, double>& motion,
                               const typename Kernel::template Header<double, Law>& header,
                               const typename Kernel::template Point<double, Law>* point,
                               ElementSample& sample) {
  kernel.complete(motion, header, point, sample);
};

/// The contract of a kernel with a law.
template <class Kernel, class Law>
concept ElementKernel = MaterialLaw<Law> && HasKernelMembers<Kernel, Law> && HasGyration<Kernel, Law> &&
    announces_its_stations<Kernel>;

/// The same in sentences: what is wrong with a kernel that is no ElementKernel.
template <class Kernel, class Law>
constexpr void check_kernel() {
  static_assert(MaterialLaw<Law>, "the law of a kernel is no MaterialLaw (materials/material_law.hpp)");
  static_assert(
      HasKernelMembers<Kernel, Law>,
      "a kernel needs kernel_traits, Settings, most_points, points(), point_size(volume), Header with "
      "mass, Point with history, initialize(), force() and sample() (elements/base/element_kind.hpp)");
  static_assert(HasGyration<Kernel, Law>, "a kernel whose nodes turn needs gyration_of(header)");
  static_assert(announces_its_stations<Kernel>, "kernel_traits.stations and stations() disagree");
  static_assert(Kernel::kernel_traits.completes_samples == HasComplete<Kernel, Law>,
                "kernel_traits.completes_samples and complete() disagree");
}

/// Settings of a kind that a deck can name.
template <class Kind>
struct CheckedKind {
  static_assert(ElementSettings<Kind>,
                "settings of an element need name, nodes, rotations, traits, fields() and "
                "contact_thickness() (elements/base/element_kind.hpp)");
  using Type = Kind;
};
template <class... Kind>
using ElementList = std::variant<typename CheckedKind<Kind>::Type...>;

/// Keys of the summary, each once, in the order of the kinds. \param kinds any value of the list
template <class... Kind>
std::vector<std::string_view> summary_keys(const std::variant<Kind...>&) {
  std::vector<std::string_view> keys;
  for (const std::string_view key : {Kind::traits.summary_key...})
    if (!key.empty() && std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
  return keys;
}

}  // namespace brio
