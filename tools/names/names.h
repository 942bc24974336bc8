// Names as people type them: without accents, in any case, with a slip.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plumb::tools {

// In lower case, Latin letters without accents, words apart by single spaces: "6  Küche/Bad" is "6 kuche bad". Other scripts stay as they
// are.
[[nodiscard]] std::string Folded(std::string_view utf8);

// The same with umlauts written out, as in German: "kueche", and "strasse" for "Straße", as Folded has it, too.
[[nodiscard]] std::string FoldedGerman(std::string_view utf8);

// Equal when folded, each in either way; a name of which folding leaves nothing is only the same as itself.
[[nodiscard]] bool IsSameName(std::string_view a, std::string_view b);

// `part` is one or more of the words of `name`, one after the other: "Kueche" of "6 Küche". Never if it has no word.
[[nodiscard]] bool IsPartOfName(std::string_view part, std::string_view name);

// The one of `names` that is nearest to `name` by edits; empty where none is near (more edits than one, plus a third of its letters, or one
// for each of them).
[[nodiscard]] std::string NearestName(const std::string& name, const std::vector<std::string>& names);

}  // namespace plumb::tools
