// Cutting openings out of bodies, and finding which door stands in which opening where the file does not say.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "compiler/frontends/ifc/ifc_model.h"
#include "compiler/frontends/ifc/ifc_options.h"
#include "compiler/geometry/solid.h"

namespace plumb::compiler {

struct CutPair {
  uint32_t host, opening;  // instances, for diagnostics
};

// Cuts `tool` out of `body`; of a body that is not closed, its surface. True: that took something away. A cut that fails or gives an
// impossible volume is left out, with a BooleanFailed diagnostic.
bool CutOpening(const IfcModel& model, CutPair pair, const IfcOptions& options, const Solid& tool, Solid& body);

// The same of tools that lie apart from one another, in one step; by tool: it took something away. None: that is not to be had, as the body
// is not closed or the volume of the result is impossible, and nothing was cut.
[[nodiscard]] std::optional<std::vector<bool>> CutApart(std::span<const Solid* const> tools, const IfcOptions& options, Solid& body);

// Numbers of `boxes`, in groups within which no two come closer than `margin_m`. Each box goes to the first group that takes it.
[[nodiscard]] std::vector<std::vector<size_t>> GroupsApart(std::span<const Eigen::AlignedBox3d> boxes, double margin_m);

// What `opening` takes of a straight wall whose body the program that wrote the file has cut already: the part of the opening within the
// wall's box in the wall's own frame. Empty if the wall is no thin upright box, or if they do not meet.
[[nodiscard]] Solid PieceCutBefore(const Solid& opening, const Eigen::Isometry3d& T_plan_wall, const Solid& wall,
                                   const IfcOptions& options);

struct FillCandidate {
  uint32_t index;
  Eigen::AlignedBox3d box;
};

// Pairs (filling, opening), each used once, best first: the filling's box lies in the opening's box to at least `min_overlap` and reaches
// as high. Ordered by filling.
[[nodiscard]] std::vector<std::pair<uint32_t, uint32_t>> MatchFillings(const std::vector<FillCandidate>& fillings,
                                                                       const std::vector<FillCandidate>& openings, double min_overlap);

}  // namespace plumb::compiler
