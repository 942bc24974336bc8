// Positions of attributes in the argument lists of IFC instances. Every use of a position in the frontend comes from here.
// They hold for IFC2X to IFC4X3: later releases append attributes or make them optional, they do not move those used here. The few that
// did move (IfcTessellatedFaceSet.Closed, the normals of face sets) are not used.
#pragma once

#include <cstddef>

namespace plumb::compiler::attribute {

// IfcRoot and what every IfcObject, IfcProduct and IfcElement has.
inline constexpr size_t kGlobalId = 0, kName = 2, kPlacement = 5, kRepresentation = 6;
inline constexpr size_t kSpatialLongName = 7, kStoreyElevation = 9;
inline constexpr size_t kOverallHeight = 8, kOverallWidth = 9;                // IfcDoor, IfcWindow
inline constexpr size_t kDoorOperation = 11, kDoorUserDefinedOperation = 12;  // IfcDoor, since IFC4
inline constexpr size_t kTypePropertySets = 5, kTypeRepresentationMaps = 6;   // IfcTypeProduct
inline constexpr size_t kDoorTypeOperation = 10, kDoorTypeUserDefinedOperation = 12, kDoorStyleOperation = 8;
inline constexpr size_t kPanelWidth = 6, kPanelPosition = 7;  // IfcDoorPanelProperties; the width as a share of the door's
inline constexpr size_t kSlabType = 8, kObjectType = 4;
inline constexpr size_t kProjectUnits = 8;
inline constexpr size_t kContextTrueNorth = 5;

// Relations.
inline constexpr size_t kContainedElements = 4, kContainingStructure = 5;
inline constexpr size_t kAggregateWhole = 4, kAggregateParts = 5;
inline constexpr size_t kVoidedElement = 4, kVoidingOpening = 5;
inline constexpr size_t kFilledOpening = 4, kFillingElement = 5;
inline constexpr size_t kRelatedObjects = 4,
                        kRelatingDefinition = 5;  // IfcRelDefinesByProperties, IfcRelDefinesByType, IfcRelAssociatesMaterial

// Properties, materials, styles.
inline constexpr size_t kPropertySetName = 2, kPropertySetProperties = 4;
inline constexpr size_t kPropertyName = 0, kPropertyValue = 2;
inline constexpr size_t kMaterialName = 0, kLayerMaterial = 0, kLayerThickness = 1, kLayerSetLayers = 0, kLayerUsageSet = 0;
inline constexpr size_t kMaterialListMaterials = 0, kConstituentSetConstituents = 2, kConstituentMaterial = 2;
inline constexpr size_t kMaterialRepresentations = 2, kRepresentedMaterial = 3;  // IfcMaterialDefinitionRepresentation
inline constexpr size_t kStyledItemItem = 0, kStyledItemStyles = 1, kStyleAssignmentStyles = 0;
inline constexpr size_t kSurfaceStyleName = 0, kSurfaceStyleStyles = 2, kShadingTransparency = 1;

// Units.
inline constexpr size_t kAssignedUnits = 0, kUnitType = 1, kSiPrefix = 2, kConversionFactor = 3;
inline constexpr size_t kMeasureValue = 0, kMeasureUnit = 1;

// Georeference.
inline constexpr size_t kMapEastings = 2, kMapNorthings = 3;

// Placements and transformations.
inline constexpr size_t kCoordinates = 0, kDirectionRatios = 0, kVectorOrientation = 0, kVectorMagnitude = 1;
inline constexpr size_t kLocation = 0, kAxis = 1, kRefDirection3D = 2, kRefDirection2D = 1;
inline constexpr size_t kGridUAxes = 7, kGridVAxes = 8, kGridWAxes = 9, kGridAxisCurve = 1, kGridAxisSameSense = 2;
inline constexpr size_t kIntersectingAxes = 0, kGridOffsets = 1;  // IfcVirtualGridIntersection
inline constexpr size_t kPlacementRelTo = 0, kRelativePlacement = 1, kLinearCartesianPosition = 2;
inline constexpr size_t kOperatorAxis1 = 0, kOperatorAxis2 = 1, kOperatorOrigin = 2, kOperatorScale = 3, kOperatorAxis3 = 4;
inline constexpr size_t kOperatorScale2In2D = 4, kOperatorScale2 = 5, kOperatorScale3 = 6;

// Representations.
inline constexpr size_t kShapeRepresentations = 2;  // IfcProductDefinitionShape
inline constexpr size_t kRepresentationIdentifier = 1, kRepresentationType = 2, kRepresentationItems = 3;
inline constexpr size_t kSetElements = 0;  // IfcGeometricSet
inline constexpr size_t kMapOrigin = 0, kMappedRepresentation = 1, kMappingSource = 0, kMappingTarget = 1;

// Solids and surfaces.
inline constexpr size_t kSweptArea = 0, kSweptPosition = 1, kExtrudedDirection = 2, kExtrusionDepth = 3, kEndSweptArea = 4;
inline constexpr size_t kRevolutionAxis = 2, kRevolutionAngle = 3;
inline constexpr size_t kDirectrix = 0, kDiskRadius = 1;
inline constexpr size_t kBooleanOperator = 0, kFirstOperand = 1, kSecondOperand = 2, kCsgTree = 0;
inline constexpr size_t kHalfSpaceSurface = 0, kHalfSpaceAgreement = 1, kBoundedPosition = 2, kBoundedBoundary = 3;
inline constexpr size_t kSurfacePosition = 0, kCylinderSurfaceRadius = 1;
inline constexpr size_t kSweptCurve = 0, kSweptSurfacePosition = 1, kExtrudedSurfaceDirection = 2, kRevolvedSurfaceAxis = 2;
inline constexpr size_t kSurfaceDegreeU = 0, kSurfaceDegreeV = 1, kSurfacePoints = 2, kSurfaceMultiplicitiesU = 7,
                        kSurfaceMultiplicitiesV = 8, kSurfaceKnotsU = 9, kSurfaceKnotsV = 10, kSurfaceWeights = 12;
inline constexpr size_t kPrimitivePosition = 0, kBlockX = 1, kBlockY = 2, kBlockZ = 3, kCylinderHeight = 1, kCylinderRadius = 2,
                        kSphereRadius = 1;  // pyramids are measured as blocks, cones as cylinders
inline constexpr size_t kBrepOuter = 0, kBrepVoids = 1, kModelShells = 0, kShellFaces = 0;
inline constexpr size_t kFaceBounds = 0, kFaceSurface = 1, kFaceSameSense = 2, kBoundLoop = 0, kBoundOrientation = 1, kLoopPoints = 0,
                        kLoopEdges = 0;
inline constexpr size_t kEdgeStart = 0, kEdgeEnd = 1, kOrientedEdgeElement = 2, kOrientedEdgeOrientation = 3, kEdgeGeometry = 2,
                        kEdgeSameSense = 3;
inline constexpr size_t kVertexGeometry = 0;
inline constexpr size_t kFaceSetCoordinates = 0, kTriangleIndices = 3, kPolygonFaces = 2, kPolygonPointIndices = 3, kPolygonIndices = 0,
                        kPolygonInnerIndices = 1;
inline constexpr size_t kPointListCoordinates = 0;
inline constexpr size_t kBoxCorner = 0, kBoxX = 1, kBoxY = 2, kBoxZ = 3;

// Curves.
inline constexpr size_t kCurve3D = 0;  // of curves on surfaces
inline constexpr size_t kPolylinePoints = 0, kCompositeSegments = 0, kSegmentSameSense = 1, kSegmentCurve = 2;
inline constexpr size_t kTrimBasis = 0, kTrim1 = 1, kTrim2 = 2, kTrimSense = 3, kTrimMaster = 4;
inline constexpr size_t kConicPosition = 0, kCircleRadius = 1, kEllipseAxis1 = 1, kEllipseAxis2 = 2, kLinePoint = 0, kLineDirection = 1;
inline constexpr size_t kIndexedPoints = 0, kIndexedSegments = 1;
inline constexpr size_t kSplineDegree = 0, kSplinePoints = 1, kSplineMultiplicities = 5, kSplineKnots = 6, kSplineWeights = 8;

// Profiles.
inline constexpr size_t kProfileCurve = 2, kProfileInnerCurves = 3, kProfilePosition = 2;
inline constexpr size_t kProfileX = 3, kProfileY = 4, kHollowRectangleThickness = 5, kHollowCircleThickness = 4;
inline constexpr size_t kShapeDim1 = 3, kShapeDim2 = 4, kShapeDim3 = 5,
                        kShapeDim4 = 6;  // I, L, T, U, C, Z and trapezium in their own orders
inline constexpr size_t kCenterLineThickness = 3, kCompositeProfiles = 2, kParentProfile = 2, kDerivedOperator = 3;

}  // namespace plumb::compiler::attribute
