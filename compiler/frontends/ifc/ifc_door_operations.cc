#include "compiler/frontends/ifc/ifc_door_operations.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <utility>

namespace plumb::compiler {
namespace {

using Op = LeafOperation;

struct NamedOperation {
  std::string_view name;
  std::array<FramedLeaf, 2> leaves;
  size_t count = 1;
};

constexpr FramedLeaf Left(Op operation, int opens_to_y = 0) { return {operation, -1, opens_to_y, 0}; }
constexpr FramedLeaf Right(Op operation, int opens_to_y = 0) { return {operation, +1, opens_to_y, 0}; }
constexpr FramedLeaf Whole(Op operation, int opens_to_y = 0) { return {operation, 0, opens_to_y, 0}; }

// The standard says of OPPOSITE_LEFT that both leaves open to the left, one along y and the other against it: each as seen by who goes
// through it, so that the one that opens along y hangs at the left jamb and the other at the right one. Where sliding leaves run, on
// which side of the wall or within it, no enumerator says.
constexpr NamedOperation kOperations[] = {
    {"SINGLE_SWING_LEFT", {Left(Op::kSwing, 1)}},
    {"SINGLE_SWING_RIGHT", {Right(Op::kSwing, 1)}},
    {"DOUBLE_DOOR_SINGLE_SWING", {Left(Op::kSwing, 1), Right(Op::kSwing, 1)}, 2},
    {"DOUBLE_DOOR_SINGLE_SWING_OPPOSITE_LEFT", {Left(Op::kSwing, 1), Right(Op::kSwing, -1)}, 2},
    {"DOUBLE_DOOR_SINGLE_SWING_OPPOSITE_RIGHT", {Left(Op::kSwing, -1), Right(Op::kSwing, 1)}, 2},
    {"DOUBLE_SWING_LEFT", {Left(Op::kDoubleActing)}},
    {"DOUBLE_SWING_RIGHT", {Right(Op::kDoubleActing)}},
    {"DOUBLE_DOOR_DOUBLE_SWING", {Left(Op::kDoubleActing), Right(Op::kDoubleActing)}, 2},
    {"SLIDING_TO_LEFT", {Left(Op::kSliding)}},
    {"SLIDING_TO_RIGHT", {Right(Op::kSliding)}},
    {"DOUBLE_DOOR_SLIDING", {Left(Op::kSliding), Right(Op::kSliding)}, 2},
    {"FOLDING_TO_LEFT", {Left(Op::kFolding, 1)}},
    {"FOLDING_TO_RIGHT", {Right(Op::kFolding, 1)}},
    {"DOUBLE_DOOR_FOLDING", {Left(Op::kFolding, 1), Right(Op::kFolding, 1)}, 2},
    {"REVOLVING", {Whole(Op::kRevolving)}},
    {"REVOLVING_HORIZONTAL", {Whole(Op::kRevolving)}},
    {"REVOLVING_VERTICAL", {Whole(Op::kRevolving)}},
    {"ROLLINGUP", {Whole(Op::kLifting, 1)}},
    {"SWING_FIXED_LEFT", {Left(Op::kSwing, 1), Right(Op::kFixed)}, 2},
    {"SWING_FIXED_RIGHT", {Left(Op::kFixed), Right(Op::kSwing, 1)}, 2},
    {"LIFTING_HORIZONTAL", {Whole(Op::kLifting)}},
    {"LIFTING_VERTICAL_LEFT", {Left(Op::kLifting)}},
    {"LIFTING_VERTICAL_RIGHT", {Right(Op::kLifting)}},
    {"DOUBLE_DOOR_LIFTING_VERTICAL", {Left(Op::kLifting), Right(Op::kLifting)}, 2},
};

// Parts of words, the first that fits decides.
constexpr std::pair<std::string_view, Op> kWords[] = {{"REVOLV", Op::kRevolving},    {"SLID", Op::kSliding},
                                                      {"POCKET", Op::kSliding},      {"FOLD", Op::kFolding},
                                                      {"ROLL", Op::kLifting},        {"OVERHEAD", Op::kLifting},
                                                      {"UP_AND_OVER", Op::kLifting}, {"SECTIONAL", Op::kLifting},
                                                      {"LIFT", Op::kLifting},        {"DOUBLE_ACTING", Op::kDoubleActing}};

}  // namespace

std::vector<FramedLeaf> LeavesByOperation(std::string_view name) {
  constexpr std::string_view kPanel = "DOUBLE_PANEL_";
  std::string known(name);
  if (name.starts_with(kPanel)) known = "DOUBLE_DOOR_" + std::string(name.substr(kPanel.size()));
  const auto* found = std::find_if(std::begin(kOperations), std::end(kOperations), [&](const auto& o) { return o.name == known; });
  if (found == std::end(kOperations)) return {};
  return {found->leaves.begin(), found->leaves.begin() + static_cast<std::ptrdiff_t>(found->count)};
}

std::vector<FramedLeaf> LeavesByWords(std::string_view text) {
  std::string name;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    name += std::isalnum(byte) != 0 ? static_cast<char>(std::toupper(byte)) : '_';
  }
  if (std::vector<FramedLeaf> leaves = LeavesByOperation(name); !leaves.empty()) return leaves;
  for (const auto& [word, operation] : kWords) {
    if (name.find(word) != std::string::npos) return {Whole(operation)};
  }
  return {};
}

}  // namespace plumb::compiler
