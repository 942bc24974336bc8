#include "compiler/frontends/sdf/sdf_frontend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "tests/support/temporary_folder.h"

namespace plumb::compiler {
namespace {

namespace fs = std::filesystem;

// A model on four walls 0.2 m thick around 6 m by 4 m, 2.7 m high; `more` goes into it.
std::string ModelOf(const std::string& more) {
  std::string out = "<model name='m'>";
  const auto wall = [&](const char* name, const char* pose, const char* size) {
    out += std::string("<link name='") + name + "'><pose>" + pose + "</pose><collision name='c'><geometry><box><size>" + size +
           "</size></box></geometry></collision></link>";
  };
  wall("south", "3 0.1 1.35 0 0 0", "6 0.2 2.7");
  wall("north", "3 3.9 1.35 0 0 0", "6 0.2 2.7");
  wall("west", "0.1 2 1.35 0 0 1.5707963267948966", "3.6 0.2 2.7");
  wall("east", "5.9 2 1.35 0 0 1.5707963267948966", "3.6 0.2 2.7");
  return out + more + "</model>";
}

std::string LinkOf(const std::string& geometry, const std::string& pose = "0 0 0 0 0 0") {
  return "<link name='extra'><pose>" + pose + "</pose><collision name='c'><geometry>" + geometry + "</geometry></collision></link>";
}

class SdfFrontend : public testing::Test {
 protected:
  void Write(const std::string& name, const std::string& text) const {
    fs::create_directories((fs::path(folder_.path()) / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::optional<PlanIr> Read(const std::string& content, const MeshOptions& options = {}) {
    Source source;
    source.path = folder_ / "plan.world";
    source.bytes = "<sdf version='1.6'>" + content + "</sdf>";
    source.format = SourceFormat::kSdf;
    return ReadSdf(source, sink_, options);
  }
  size_t CountOf(DiagnosticKind kind) const {
    return static_cast<size_t>(std::count_if(sink_.all().begin(), sink_.all().end(), [&](const Diagnostic& d) { return d.kind == kind; }));
  }
  static Eigen::AlignedBox3d BoxOf(const std::optional<PlanIr>& plan, const std::string& name) {
    Eigen::AlignedBox3d out;
    for (const PlanElement& e : plan ? plan->elements : std::vector<PlanElement>()) {
      if (e.name.starts_with(name)) out.extend(Bounds(e.body));
    }
    return out;
  }
  static void ExpectBox(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& low, const Eigen::Vector3d& high, double slack_m = 1e-6) {
    EXPECT_LT((box.min() - low).norm(), slack_m) << box.min().transpose();
    EXPECT_LT((box.max() - high).norm(), slack_m) << box.max().transpose();
  }

  const plumb::test::TemporaryFolder folder_;
  DiagnosticSink sink_;
};

TEST_F(SdfFrontend, PlacesTheBoxesOfLinks) {
  const auto plan = Read(ModelOf(""));
  ASSERT_TRUE(plan);
  ExpectBox(BoxOf(plan, "m/west"), {0, 0.2, 0}, {0.2, 3.8, 2.7});
  EXPECT_EQ(sink_.Count(Severity::kWarning), 0u);
}

TEST_F(SdfFrontend, ReadsCylinders) {
  const auto plan = Read(ModelOf(LinkOf("<cylinder><radius>0.3</radius><length>1</length></cylinder>", "3 2 0.5 0 0 0")));
  ExpectBox(BoxOf(plan, "m/extra"), {2.7, 1.7, 0}, {3.3, 2.3, 1}, 0.01);
}

TEST_F(SdfFrontend, ReadsSpheres) {
  const auto plan = Read(ModelOf(LinkOf("<sphere><radius>0.4</radius></sphere>", "3 2 1 0 0 0")));
  ExpectBox(BoxOf(plan, "m/extra"), {2.6, 1.6, 0.6}, {3.4, 2.4, 1.4}, 0.02);
}

TEST_F(SdfFrontend, ReadsPolylinesFromTheirGroundUp) {
  const auto plan = Read(
      ModelOf(LinkOf("<polyline><height>0.7</height><point>0 0</point><point>1 0</point><point>1 0.5</point></polyline>", "2 2 0 0 0 0")));
  ExpectBox(BoxOf(plan, "m/extra"), {2, 2, 0}, {3, 2.5, 0.7});
}

TEST_F(SdfFrontend, ReadsPlanesNoFartherThanASite) {
  const auto plan = Read(ModelOf(LinkOf("<plane><normal>0 0 1</normal><size>1e4 20</size></plane>")));
  ExpectBox(BoxOf(plan, "m/extra"), {-100, -10, 0}, {100, 10, 0});
}

TEST_F(SdfFrontend, ReadsMeshesWithTheirScale) {
  Write("meshes/block.obj", "o b\nv 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const auto plan = Read(ModelOf(LinkOf("<mesh><uri>meshes/block.obj</uri><scale>0.1 0.1 0.05</scale></mesh>", "2 2 0 0 0 0")));
  ExpectBox(BoxOf(plan, "m/extra"), {2, 2, 0}, {3, 3, 0.5});
}

TEST_F(SdfFrontend, NestsPosesOfModelsLinksAndShapes) {
  const std::string inner =
      "<model name='inner'><pose>1 1 0 0 0 1.5707963267948966</pose><link name='extra'><pose>1 0 0 0 0 0</pose><collision name='c'>"
      "<pose>0 0 0.5 0 0 0</pose><geometry><box><size>0.4 0.2 1</size></box></geometry></collision></link></model>";
  const auto plan = Read(ModelOf(inner));
  ASSERT_TRUE(plan);
  ExpectBox(BoxOf(plan, "m/extra"), {0.9, 1.8, 0}, {1.1, 2.2, 1});
}

TEST_F(SdfFrontend, IncludesModelsOfItsFolderWithTheirPose) {
  Write("models/post/model.sdf",
        "<sdf version='1.6'><model name='post'><link name='l'><collision name='c'><geometry><box>"
        "<size>0.2 0.2 1</size></box></geometry></collision></link></model></sdf>");
  const auto plan = Read("<world name='w'>" + ModelOf("") +
                         "<include><uri>model://post</uri><name>post_1</name><pose>3 2 0.5 0 0 0</pose></include></world>");
  ExpectBox(BoxOf(plan, "post_1"), {2.9, 1.9, 0}, {3.1, 2.1, 1});
}

TEST_F(SdfFrontend, IncludesModelsOfTheModelPath) {
  const plumb::test::TemporaryFolder elsewhere;
  fs::create_directories(elsewhere / "post");
  std::ofstream(elsewhere / "post/model.sdf") << "<sdf version='1.6'><model name='post'><link name='l'><collision name='c'><geometry><box>"
                                                 "<size>0.2 0.2 1</size></box></geometry></collision></link></model></sdf>";
  MeshOptions options;
  options.model_path = {elsewhere.path()};
  const auto plan = Read("<world name='w'>" + ModelOf("") + "<include><uri>model://post</uri></include></world>", options);
  EXPECT_FALSE(BoxOf(plan, "post").isEmpty());
  EXPECT_EQ(CountOf(DiagnosticKind::kIncludeMissing), 0u);
}

TEST_F(SdfFrontend, ReadsTheRestWhereModelsAreMissingAndNamesEach) {
  MeshOptions options;
  options.model_path = {folder_ / "robots"};
  const auto plan = Read(
      "<world name='w'>" + ModelOf("") + "<include><uri>model://table</uri></include><include><uri>model://chair</uri></include></world>",
      options);
  ASSERT_TRUE(plan);
  EXPECT_GE(plan->elements.size(), 4u);
  ASSERT_EQ(CountOf(DiagnosticKind::kIncludeMissing), 2u);
  const auto missing =
      std::find_if(sink_.all().begin(), sink_.all().end(), [](const Diagnostic& d) { return d.kind == DiagnosticKind::kIncludeMissing; });
  EXPECT_NE(missing->message.find("`model://table`"), std::string::npos);
  EXPECT_NE(missing->message.find(options.model_path[0]), std::string::npos);
  EXPECT_NE(missing->hint.find("--model-path"), std::string::npos);
}

TEST_F(SdfFrontend, SaysThatNothingIsLeftWhereAllModelsAreMissing) {
  EXPECT_FALSE(Read("<world name='w'><include><uri>model://house</uri></include></world>"));
  EXPECT_EQ(CountOf(DiagnosticKind::kIncludeMissing), 1u);
  EXPECT_EQ(CountOf(DiagnosticKind::kSdfWithoutShapes), 1u);
}

TEST_F(SdfFrontend, ReadsNoFileAboveItsFolder) {
  const auto plan = Read(ModelOf(LinkOf("<mesh><uri>../../etc/wall.obj</uri></mesh>") + LinkOf("<mesh><uri>http://a/b.obj</uri></mesh>")));
  ASSERT_TRUE(plan);
  EXPECT_EQ(CountOf(DiagnosticKind::kIncludeOutside), 2u);
}

TEST_F(SdfFrontend, StopsAtAModelThatIncludesItself) {
  Write("loop/model.sdf", "<sdf version='1.6'><model name='loop'><include><uri>model://loop</uri></include></model></sdf>");
  EXPECT_TRUE(Read("<world name='w'>" + ModelOf("") + "<include><uri>model://loop</uri></include></world>"));
  EXPECT_EQ(CountOf(DiagnosticKind::kXmlTooDeep), 1u);
}

TEST_F(SdfFrontend, LeavesOutShapesWithoutASize) {
  const auto plan = Read(ModelOf(LinkOf("<box><size>1 nan 1</size></box>") + LinkOf("<box><size>1 1</size></box>") +
                                 LinkOf("<cylinder><radius>-1</radius><length>1</length></cylinder>")));
  ASSERT_TRUE(plan);
  EXPECT_TRUE(BoxOf(plan, "m/extra").isEmpty());
  EXPECT_EQ(CountOf(DiagnosticKind::kXmlBadValue), 2u);
}

}  // namespace
}  // namespace plumb::compiler
