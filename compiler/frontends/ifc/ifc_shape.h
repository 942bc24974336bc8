// Shapes of IFC products: representation items as solids. Metres, in the product's own frame.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <unordered_map>
#include <vector>

#include "compiler/frontends/ifc/ifc_booleans.h"
#include "compiler/frontends/ifc/ifc_curves.h"
#include "compiler/frontends/ifc/ifc_faces.h"
#include "compiler/frontends/ifc/ifc_options.h"
#include "compiler/frontends/ifc/ifc_profiles.h"
#include "compiler/frontends/ifc/ifc_shape_part.h"
#include "compiler/frontends/ifc/ifc_styles.h"
#include "compiler/geometry/solid.h"

namespace plumb::compiler {

void TransformPart(const Eigen::Affine3d& T_out_part, ShapePart& part);
// Leaves out the parts with vertices over kMaxCoordinate_m from the origin, with a diagnostic about `instance`.
void KeepInRange(const IfcModel& model, uint32_t instance, ShapeParts& parts);

class ShapeReader {
 public:
  // `placements` must outlive the reader.
  ShapeReader(const IfcModel& model, const PlacementReader& placements, const StyleReader& styles, const IfcOptions& options);

  // The body of a product (IfcProductDefinitionShape): one part for each representation item. A bounding box where nothing else is given
  // or readable, with a diagnostic. Empty if it has none.
  [[nodiscard]] ShapeParts Body(const IfcInstance& definition_shape);

  // The first and last point of the Axis representation. None if there is none.
  [[nodiscard]] std::optional<std::pair<Eigen::Vector3d, Eigen::Vector3d>> Axis(const IfcInstance& definition_shape) const;

 private:
  // With a diagnostic about `whole`.
  [[nodiscard]] bool TooLarge(const ShapeParts& parts, uint32_t whole) const;
  [[nodiscard]] ShapeParts Representation(const IfcInstance& representation, int depth);
  [[nodiscard]] ShapeParts Item(const IfcInstance& item, int depth);
  [[nodiscard]] ShapeParts ReadItem(const IfcInstance& item, int depth);
  [[nodiscard]] ShapeParts Mapped(const IfcInstance& item, int depth);
  [[nodiscard]] ShapeParts Extruded(const IfcInstance& item);
  [[nodiscard]] ShapeParts Revolved(const IfcInstance& item);
  [[nodiscard]] ShapeParts Disk(const IfcInstance& item);
  [[nodiscard]] ShapeParts Primitive(const IfcInstance& item);
  [[nodiscard]] ShapeParts Boolean(const IfcInstance& item, int depth);
  [[nodiscard]] ShapeParts SurfaceModel(const IfcInstance& item);
  void Combine(const IfcInstance& item, int depth, ShapeParts& parts);
  void ApplyLook(const IfcInstance& item, ShapeParts& parts) const;
  [[nodiscard]] Solid BoundingBox(const IfcInstance& item) const;

  const IfcModel& model_;
  const PlacementReader& placements_;
  const StyleReader& styles_;
  IfcOptions options_;
  CurveReader curves_;
  ProfileReader profiles_;
  FaceReader faces_;
  BooleanCutter booleans_;
  std::unordered_map<uint32_t, std::optional<ShapeParts>> mapped_;  // by IfcRepresentationMap, in its own frame; none while it is read
  std::unordered_map<uint32_t, size_t> map_items_left_;             // IfcMappedItems that refer to it and were not met yet
};

}  // namespace plumb::compiler
