#include <filesystem>

#include "apps/commands.hpp"
#include "apps/first_deck.hpp"
#include "apps/streams.hpp"
#include "io/files/text_file.hpp"
#include "io/yaml/deck_error.hpp"

namespace brio {

void write_new_deck(const std::filesystem::path& name) {
  std::filesystem::path path = name;
  if (path.extension() != ".yaml") path += ".yaml";
  const std::string stem = path.stem().string();
  if (stem.empty() || stem == ".yaml") throw DeckError("brio: '" + name.string() + "' is no name of a deck");
  if (std::filesystem::exists(std::filesystem::symlink_status(path)))
    throw DeckError(path.string() + ": is there already; accepted: a name that is not taken");
  std::string text(first_deck);
  const std::string_view placeholder = "NAME";
  for (std::size_t at = 0; (at = text.find(placeholder, at)) != std::string::npos; at += stem.size())
    text.replace(at, placeholder.size(), stem);
  replace_text_file(path, {text});
  write_out("{}\nnext: brio run {}\n", path.string(), path.string());
}

}  // namespace brio
