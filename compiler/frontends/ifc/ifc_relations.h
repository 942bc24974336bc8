// Relations between the objects of an IFC file, turned round so that each object knows its own.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>

#include "compiler/frontends/ifc/ifc_model.h"

namespace plumb::compiler {

// From some instances to one other each. Few of a file's instances are in a relation: far smaller than a list of all.
class InstanceMap {
 public:
  // StepFile::kNone where there is none.
  [[nodiscard]] uint32_t operator[](uint32_t from) const {
    const auto found = to_.find(from);
    return found == to_.end() ? StepFile::kNone : found->second;
  }
  void Set(uint32_t from, uint32_t to) { to_[from] = to; }

 private:
  std::unordered_map<uint32_t, uint32_t> to_;
};

class Relations {
 public:
  explicit Relations(const IfcModel& model);

  // StepFile::kNone where there is none.
  [[nodiscard]] uint32_t WholeOf(uint32_t part) const { return whole_[part]; }                // IfcRelAggregates, IfcRelNests
  [[nodiscard]] uint32_t StructureOf(uint32_t element) const { return structure_[element]; }  // IfcRelContainedInSpatialStructure
  [[nodiscard]] uint32_t HostOf(uint32_t opening) const { return host_[opening]; }            // IfcRelVoidsElement
  [[nodiscard]] uint32_t OpeningOf(uint32_t filling) const { return opening_[filling]; }      // IfcRelFillsElement
  [[nodiscard]] uint32_t TypeOf(uint32_t object) const { return type_[object]; }              // IfcRelDefinesByType
  [[nodiscard]] uint32_t MaterialOf(uint32_t object) const;              // IfcRelAssociatesMaterial, else that of its type
  [[nodiscard]] std::optional<bool> IsExternal(uint32_t element) const;  // Pset_WallCommon and its kind

  // The storey that holds an object directly or through what it is part of, what it fills or what it voids.
  [[nodiscard]] uint32_t StoreyOf(uint32_t object) const;

  // The sum of the material layers, if layers are what the object is made of.
  [[nodiscard]] std::optional<double> LayerThickness_m(uint32_t object) const;

 private:
  void ReadOneToMany(IfcType relation, size_t one, size_t many, InstanceMap& one_of_many) const;
  void ReadExternal();

  const IfcModel& model_;
  InstanceMap whole_, structure_, host_, opening_, material_, type_;
  std::unordered_map<uint32_t, bool> external_;
};

}  // namespace plumb::compiler
