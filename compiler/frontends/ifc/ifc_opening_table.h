// The openings of an IFC file: what they cut and what fills them.
#pragma once

#include <span>
#include <vector>

#include "compiler/frontends/ifc/ifc_product_table.h"

namespace plumb::compiler {

struct Opening {
  uint32_t instance = StepFile::kNone;
  uint32_t product = kNoIndex;  // that it voids
  uint32_t filling = kNoIndex;  // product, after AssignFillings
  std::vector<Solid> solids;    // plan frame
  bool cuts = false;            // it took something from its host
  bool cut_before = false;      // its host was written without what it takes
};

class OpeningTable {
 public:
  // Reads every opening that voids something. What is passed must outlive the table.
  OpeningTable(const IfcModel& model, PlacementReader& placements, const Relations& relations, ProductTable& products,
               const IfcOptions& options);

  [[nodiscard]] const std::vector<Opening>& all() const { return openings_; }  // in the order of the file

  [[nodiscard]] bool HasOpenings(uint32_t product) const { return !of_product_[product].empty(); }

  // Cuts out of a product's parts its own openings and, for parts that stay elements of their own, those of the wholes above them.
  void Cut(uint32_t product, ShapeParts& parts);
  // Some programs write bodies that are cut already: adds to the uncut body of a straight wall what such openings took. After Cut.
  void RestoreUncut(uint32_t product, Solid& uncut);
  // By IfcRelFillsElement; doors, windows and curtain walls without one are looked for in the openings that are left, with a diagnostic.
  void AssignFillings();

 private:
  // A solid of an opening that is to be cut out of something.
  struct Tool {
    Opening* opening;
    const Solid* solid;
  };
  [[nodiscard]] std::vector<Opening*> Cutting(uint32_t product);
  // Out of one part. False: beyond the limit.
  bool CutGroup(uint32_t product, std::span<const Tool> group, Solid& body);
  // False, with a PlanTooComplex diagnostic, beyond IfcOptions.max_cut_triangles.
  [[nodiscard]] bool SpendCut(const Solid& body, std::span<const Tool> tools);
  void AssignByPlace(const std::vector<char>& is_filling);

  const IfcModel& model_;
  PlacementReader& placements_;
  const Relations& relations_;
  const ProductTable& products_;
  const IfcOptions& options_;
  size_t cut_triangles_ = 0;
  std::vector<Opening> openings_;
  std::vector<std::vector<size_t>> of_product_;  // the openings that void it
};

}  // namespace plumb::compiler
