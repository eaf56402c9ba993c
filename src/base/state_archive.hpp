#pragma once
/// Saving and restoring the state of a run by one description of it.
///
/// A type whose objects change during a run lists once what of them is saved:
///
///     template <class Archive>
///     void serialize(Archive& archive) { archive(position_, velocity_); }
///
/// StateWriter and StateReader pass through these lists in the same order, so nothing can be written that is
/// not read. Not listed is what the input deck determines, and working space. Numbers are written as they
/// are in memory: a state is read by the same build of the program, into a model built from the same deck.

#include <array>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <istream>
#include <limits>
#include <memory>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "src/base/aligned.hpp"

namespace brio {

/// A state that ends early, or is not one of this model.
struct StateError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Whether the bytes of an object are its value: numbers, enumerations and structs of these.
template <class T>
inline constexpr bool is_plain_state = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

/// Dispatch shared by both directions. \tparam Direction has `bytes(void*, n)`, `count(n)`, which returns
/// the number of items, and `is_reader`.
template <class Direction>
class StateArchive {
 public:
  template <class... Items>
  void operator()(Items&... items) {
    (item(items), ...);
  }
  /// A word between the parts of a state, so that one that does not fit is noticed where it begins.
  void section(std::uint32_t word) {
    std::uint32_t found = word;
    item(found);
    if (found != word) throw StateError("the saved state does not fit the model");
  }

 private:
  Direction& direction() { return static_cast<Direction&>(*this); }

  template <class T>
  void item(T& value) {
    if constexpr (requires { value.serialize(direction()); }) {
      value.serialize(direction());
    } else {
      static_assert(is_plain_state<T>, "list what is saved of this type in its member function serialize()");
      direction().bytes(std::addressof(value), sizeof value);
    }
  }
  template <class First, class Second>
  void item(std::pair<First, Second>& pair) {
    item(pair.first);
    item(pair.second);
  }
  template <class T>
  void item(std::optional<T>& value) {
    if (direction().count(value ? 1 : 0) == 0)
      value.reset();
    else
      item(value ? *value : value.emplace());
  }
  template <class T>
  void item(std::vector<T>& list) {
    const std::size_t size = direction().count(list.size());
    if constexpr (Direction::is_reader) resize(list, size);
    items(list.data(), size);
  }
  void item(std::string& text) {
    const std::size_t size = direction().count(text.size());
    if constexpr (Direction::is_reader) text.resize(direction().expect(size, 1));
    direction().bytes(text.data(), size);
  }
  template <class T>
  void item(AlignedBuffer<T>& buffer) {
    const std::size_t size = direction().count(buffer.size());
    if constexpr (Direction::is_reader)
      if (size != buffer.size()) buffer = AlignedBuffer<T>(direction().expect(size, sizeof(T)));
    direction().bytes(buffer.data(), size * sizeof(T));
  }

  // An item takes at least a byte of the stream: what claims more is damaged, and allocates nothing.
  template <class T>
  void resize(std::vector<T>& list, std::size_t size) {
    list.resize(direction().expect(size, is_saved_whole<T>() ? sizeof(T) : 1));
  }
  template <class T>
  static constexpr bool is_saved_whole() {
    return is_plain_state<T> && !requires(T & item, Direction & direction) { item.serialize(direction); };
  }
  template <class T>
  void items(T* first, std::size_t size) {
    if constexpr (is_saved_whole<T>())
      direction().bytes(first, size * sizeof(T));
    else
      for (std::size_t i = 0; i < size; ++i) item(first[i]);
  }
};

class StateWriter : public StateArchive<StateWriter> {
 public:
  static constexpr bool is_reader = false;
  explicit StateWriter(std::ostream& out) : out_(out) {}

  void bytes(const void* data, std::size_t size) {
    if (size > 0) out_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  }
  std::size_t count(std::size_t size) {
    const std::uint64_t written = size;
    bytes(&written, sizeof written);
    return size;
  }

 private:
  std::ostream& out_;
};

class StateReader : public StateArchive<StateReader> {
 public:
  static constexpr bool is_reader = true;
  /// \param size bytes that the stream holds
  StateReader(std::istream& in, std::uint64_t size) : in_(in), left_(size) {}

  void bytes(void* data, std::size_t size) {
    if (size == 0) return;
    expect(size, 1);
    left_ -= size;
    if (!in_.read(static_cast<char*>(data), static_cast<std::streamsize>(size)))
      throw StateError("the saved state ends early");
  }
  std::size_t count(std::size_t /*present*/) {
    std::uint64_t size = 0;
    bytes(&size, sizeof size);
    return size;
  }
  /// \returns the number of items. \throws StateError where the stream cannot hold as many
  std::size_t expect(std::size_t items, std::size_t bytes_each) const {
    if (items > left_ / bytes_each) throw StateError("the saved state ends early");
    return items;
  }
  /// Bytes that are not read yet.
  std::uint64_t left() const { return left_; }
  bool at_end() const { return left_ == 0; }

 private:
  std::istream& in_;
  std::uint64_t left_;
};

}  // namespace brio
