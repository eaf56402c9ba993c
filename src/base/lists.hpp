#pragma once
/// Lists of different lengths in one array; lists in ascending order.

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "src/base/index.hpp"

namespace brio {

/// of(i) is list i. Built packed, one list after the other; loosened before single lists are edited, which
/// then move to the end of the array when they outgrow their room.
struct Lists {
  std::vector<int> first;  ///< where each list begins; packed: one entry more than there are lists
  std::vector<int> item;
  std::vector<int> end;   ///< where each list ends; empty while packed: where the next begins
  std::vector<int> room;  ///< where the room of each list ends; empty while packed

  std::span<const int> of(int list) const {
    const auto l = index(list);
    const auto begin = index(first[l]);
    return {item.data() + begin, index(end.empty() ? first[l + 1] : end[l]) - begin};
  }

  /// Begin anew with packed lists, all of them empty.
  void start_packed(std::size_t lists) {
    first.assign(lists + 1, 0);
    end.clear();
    room.clear();
  }

  /// Make single lists editable. Does nothing where they are.
  void loosen();
  /// Of loosened lists: append an empty one; empty one.
  void add_list();
  void clear(int list) { end[index(list)] = first[index(list)]; }
  /// Of loosened ascending lists: put in what is not yet in, take out what is in. \returns whether it
  /// changed.
  bool insert(int list, int value);
  bool erase(int list, int value);
  /// Of loosened lists: replace one.
  void assign(int list, std::span<const int> values);

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(first, item, end, room);
  }

 private:
  void make_room(int list, std::size_t size);
};

/// Ascending, each but once.
template <class T>
void sort_out(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace brio
