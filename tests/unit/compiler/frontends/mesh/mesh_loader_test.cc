#include "compiler/frontends/mesh/mesh_loader.h"

#include <gtest/gtest.h>

namespace plumb::compiler {
namespace {

constexpr const char* kTriangles = "v 0 0 0\nv 1 0 0\nv 0 1 0\no a\nf 1 2 3\no b\nf 1 3 2\n";

Source ObjOf(std::string text) {
  Source source;
  source.path = "plan.obj";
  source.bytes = std::move(text);
  source.format = SourceFormat::kObj;
  return source;
}

TEST(MeshLoader, GivesOneObjectForEachNode) {
  const auto scene = LoadMesh(ObjOf(kTriangles), {});
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_EQ(scene->objects.size(), 2u);
  EXPECT_EQ(scene->objects[0].name, "a");
  EXPECT_EQ(scene->objects[1].solid.triangles.size(), 1u);
  EXPECT_FALSE(scene->up);
  EXPECT_FALSE(scene->unit_m);
}

TEST(MeshLoader, KeepsTheDigitsOfAnObjFarFromZero) {
  const auto scene = LoadMesh(ObjOf("o a\nv 4000000.001 0 0\nv 4000000.002 0 0\nv 4000000 1 0\nf 1 2 3\n"), {});
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->origin.x(), 4000000);
  const auto& v = scene->objects[0].solid.vertices;
  EXPECT_NEAR(v[1].x() - v[0].x(), 0.001, 1e-7);
}

TEST(MeshLoader, RefusesMoreTrianglesThanAllowed) {
  MeshOptions options;
  options.max_triangles = 1;
  const auto scene = LoadMesh(ObjOf(kTriangles), options);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, ErrorCode::kFileTooLarge);
}

TEST(MeshLoader, RefusesWhatTakesMoreTimeThanAllowed) {
  std::string text = kTriangles;
  for (int i = 0; i < 200000; ++i) text += "f 1 2 3\n";
  MeshOptions options;
  options.reader_time_s = 0.001;
  const auto scene = LoadMesh(ObjOf(text), options);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, ErrorCode::kFileTooLarge);
}

TEST(MeshLoader, SaysWhyAFileIsNotRead) {
  Source source = ObjOf("glTF\2\0\0\0");
  source.format = SourceFormat::kGltf;
  const auto scene = LoadMesh(source, {});
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, ErrorCode::kFileUnreadable);
  EXPECT_FALSE(scene.error().message.empty());
}

}  // namespace
}  // namespace plumb::compiler
