#pragma once
/// What a material model (constitutive law) provides, checked by the compiler.
///
/// A law is a plain struct: the parameters that a deck sets, a history of lanes T, and updates at one
/// integration point on a number-like T (lanes.hpp). Every law has
///
///     static constexpr std::string_view name;          // its word in a deck
///     using Settings = ...;                            // the struct that a deck sets, as a rule itself
///     static constexpr MaterialTraits traits;          // which of the optional members it has
///     static constexpr auto fields();                  // entries of a deck (src/base/fields.hpp)
///     double density;                                  // mass per reference volume
///     template <class T> struct History;               // of numbers T alone; starts as zero
///     template <class T> ElasticModuli<T> moduli(const History<T>&) const;
///
/// where the moduli are the tangent of the present state, from above (they bound wave speeds and so the
/// stable time step),
/// and at least one of the updates, by which it pairs with elements:
///
///     template <class T> void update(const SymmetricTensor<T>& strain_increment,
///                                    SymmetricTensor<T>& stress, History<T>&) const;          // solids
///     template <class T> void update_from_stretch(const SymmetricTensor<T>& stretch,
///                                    SymmetricTensor<T>& stress, History<T>&) const;          // or this
///     template <class T> void update_plane_stress(const ShellTensor<T>& strain_increment,
///                                    double shear_factor, ShellTensor<T>& stress, History<T>&,
///                                    T& thickness_strain_increment) const;                    // shells
///     template <class T> void update_fibre(const FibreTensor<T>& strain_increment, FibreTensor<T>& stress,
///                                    History<T>&) const;                                      // beams
///
/// Stress is Cauchy's. Stress and strain are on axes that turn with the material (unrotated), so that a law
/// never sees a rotation; the stretch is U of F = R U.
///
/// An optional member is announced in `traits` under its own name. A trait without the member, a member
/// without its trait and a misspelt trait do not compile: no feature is switched off by a slip of the pen.

#include <concepts>
#include <optional>
#include <string_view>
#include <variant>

#include "materials/failure.hpp"
#include "materials/named_history.hpp"
#include "materials/stress_state.hpp"

namespace brio {

/// Optional members of a law, each under its name.
struct MaterialTraits {
  bool update = false;
  bool update_from_stretch = false;
  bool update_plane_stress = false;
  bool update_fibre = false;
  /// Of the history, T: equivalent plastic strain, -; an element can be deleted by it.
  bool equivalent_plastic_strain = false;
  /// Of the history, SymmetricTensor<T>: deviatoric, on the axes of the stress, with which it turns.
  bool back_stress = false;
  /// hardening(), the yield stress by equivalent plastic strain (hardening.hpp): with it hourglass control
  /// yields as the material does.
  bool hardening = false;
  /// double, the present time step, set before each step: of laws that depend on rates.
  bool time_step = false;
  /// rate_logarithm(T flow) and homologous_temperature(const History<T>&): known to fracture by rate and
  /// temperature.
  bool rate_logarithm = false;
  /// std::optional<Failure>, an entry of the deck: with it the law runs as Failing<Law> (failing.hpp).
  bool failure = false;
  /// has_failed(history), carried_share(history), start(history, size): points that can be lost.
  bool has_failed = false;
  /// The type `Reduced`, a law of less state that runs in place of this one where is_reduced().
  bool is_reduced = false;
  /// named_history(): what of the history has a name and can be written as a field (named_history.hpp).
  bool named_history = false;
  /// fault(): what is wrong with the parameters taken together; empty where nothing is.
  bool fault = false;

  constexpr bool operator==(const MaterialTraits&) const = default;
};

/// Whether a law has the members; of lanes that are one double.
namespace has {

template <class Law>
using History = typename Law::template History<double>;

template <class Law>
concept update = requires(const Law& law, const SymmetricTensor<double>& strain,
                          SymmetricTensor<double>& stress, History<Law>& history) {
  { law.update(strain, stress, history) } -> std::same_as<void>;
};
template <class Law>
concept update_from_stretch = requires(const Law& law, const SymmetricTensor<double>& stretch,
                                       SymmetricTensor<double>& stress, History<Law>& history) {
  { law.update_from_stretch(stretch, stress, history) } -> std::same_as<void>;
};
template <class Law>
concept update_plane_stress = requires(const Law& law, const ShellTensor<double>& strain,
                                       ShellTensor<double>& stress, History<Law>& history,
                                       double& thickness_strain) {
  { law.update_plane_stress(strain, 1.0, stress, history, thickness_strain) } -> std::same_as<void>;
};
template <class Law>
concept update_fibre = requires(const Law& law, const FibreTensor<double>& strain,
                                FibreTensor<double>& stress, History<Law>& history) {
  { law.update_fibre(strain, stress, history) } -> std::same_as<void>;
};
template <class Law>
concept equivalent_plastic_strain = requires(History<Law>& history) {
  { history.equivalent_plastic_strain } -> std::same_as<double&>;
};
template <class Law>
concept back_stress = requires(History<Law>& history) {
  { history.back_stress } -> std::same_as<SymmetricTensor<double>&>;
};
template <class Law>
concept hardening = requires(const Law& law) {
  law.hardening().initial_yield_stress();
};
template <class Law>
concept time_step = requires(Law& law) {
  { law.time_step } -> std::same_as<double&>;
};
template <class Law>
concept rate_logarithm = requires(const Law& law, double flow, const History<Law>& history) {
  // Of the law before it is made to fail: histories that hold more are histories of it all the same.
  { law.rate_logarithm(flow) } -> std::same_as<double>;
  { law.template homologous_temperature<double>(history) } -> std::same_as<double>;
};
template <class Law>
concept failure = requires(Law& law) {
  { law.failure } -> std::same_as<std::optional<Failure>&>;
};
template <class Law>
concept has_failed = requires(const Law& law, History<Law>& history) {
  law.has_failed(history);
  law.carried_share(history);
  law.start(history, 1.0);
};
template <class Law>
concept is_reduced = requires(const Law& law) {
  typename Law::Reduced;
  { law.is_reduced() } -> std::same_as<bool>;
};
template <class Law>
concept named_history = requires {
  Law::named_history();
};
template <class Law>
concept fault = requires(const Law& law) {
  { law.fault() } -> std::convertible_to<std::string_view>;
};

}  // namespace has

/// Members that every law has.
template <class Law>
concept HasLawMembers = requires(const Law& law, const has::History<Law>& history) {
  requires std::same_as<decltype(Law::traits), const MaterialTraits>;
  { Law::name } -> std::convertible_to<std::string_view>;
  typename Law::Settings;
  Law::fields();
  { law.density } -> std::same_as<const double&>;
  { law.template moduli<double>(history) } -> std::same_as<ElasticModuli<double>>;
};

/// The optional members that a law has, announced or not.
template <class Law>
inline constexpr MaterialTraits optional_members{
    .update = has::update<Law>,
    .update_from_stretch = has::update_from_stretch<Law>,
    .update_plane_stress = has::update_plane_stress<Law>,
    .update_fibre = has::update_fibre<Law>,
    .equivalent_plastic_strain = has::equivalent_plastic_strain<Law>,
    .back_stress = has::back_stress<Law>,
    .hardening = has::hardening<Law>,
    .time_step = has::time_step<Law>,
    .rate_logarithm = has::rate_logarithm<Law>,
    .failure = has::failure<Law>,
    .has_failed = has::has_failed<Law>,
    .is_reduced = has::is_reduced<Law>,
    .named_history = has::named_history<Law>,
    .fault = has::fault<Law>};

/// A law has an update; one that hardens or fails has a plastic strain to do it by.
constexpr bool make_sense(const MaterialTraits& traits) {
  const bool has_update =
      traits.update || traits.update_from_stretch || traits.update_plane_stress || traits.update_fibre;
  return has_update && (traits.equivalent_plastic_strain || !(traits.hardening || traits.failure));
}

template <class Law>
inline constexpr bool announces_its_members = Law::traits == optional_members<Law>;

/// The contract: members, and traits that say which of the optional ones there are.
template <class Law>
concept MaterialLaw = HasLawMembers<Law> && announces_its_members<Law> && make_sense(Law::traits);

/// The same in sentences: what is wrong with a law that is no MaterialLaw.
template <class Law>
struct CheckedLaw {
  static_assert(HasLawMembers<Law>,
                "a law needs name, Settings, traits, fields(), density, History<T> and moduli(history)");
  static constexpr MaterialTraits traits = Law::traits;
  static_assert(traits.update == has::update<Law>,
                "traits.update and update(strain_increment, stress, history) disagree");
  static_assert(traits.update_from_stretch == has::update_from_stretch<Law>,
                "traits.update_from_stretch and update_from_stretch(stretch, stress, history) disagree");
  static_assert(traits.update_plane_stress == has::update_plane_stress<Law>,
                "traits.update_plane_stress and update_plane_stress(strain_increment, shear_factor, stress, "
                "history, thickness_strain_increment) disagree");
  static_assert(traits.update_fibre == has::update_fibre<Law>,
                "traits.update_fibre and update_fibre(strain_increment, stress, history) disagree");
  static_assert(traits.equivalent_plastic_strain == has::equivalent_plastic_strain<Law>,
                "traits.equivalent_plastic_strain and T History<T>::equivalent_plastic_strain disagree");
  static_assert(traits.back_stress == has::back_stress<Law>,
                "traits.back_stress and SymmetricTensor<T> History<T>::back_stress disagree");
  static_assert(traits.hardening == has::hardening<Law>, "traits.hardening and hardening() disagree");
  static_assert(traits.time_step == has::time_step<Law>, "traits.time_step and double time_step disagree");
  static_assert(traits.rate_logarithm == has::rate_logarithm<Law>,
                "traits.rate_logarithm, rate_logarithm(flow) and homologous_temperature(history) disagree");
  static_assert(traits.failure == has::failure<Law>,
                "traits.failure and std::optional<Failure> failure disagree");
  static_assert(traits.has_failed == has::has_failed<Law>,
                "traits.has_failed, has_failed(history), carried_share(history) and start(history, size) "
                "disagree");
  static_assert(traits.is_reduced == has::is_reduced<Law>,
                "traits.is_reduced, the type Reduced and is_reduced() disagree");
  static_assert(traits.named_history == has::named_history<Law>,
                "traits.named_history and static named_history() disagree");
  static_assert(traits.fault == has::fault<Law>, "traits.fault and fault() disagree");
  static_assert(make_sense(traits),
                "a law needs one of the updates; one that hardens or fails needs equivalent_plastic_strain");
  using Type = Law;
};

/// Laws that a deck can name.
template <class... Law>
using LawList = std::variant<typename CheckedLaw<Law>::Type...>;

/// Laws that can lose a point.
template <class Law>
inline constexpr bool can_fail = Law::traits.has_failed;

}  // namespace brio
