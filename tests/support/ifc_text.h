// Small IFC files for tests.
#pragma once

#include <string>
#include <string_view>

namespace plumb::test {

// A whole file around the instances in `data`. Metres and radians: #1 is the IfcProject, #2 the IfcUnitAssignment, #3 and #4 its units.
// Ids up to 9 are taken.
[[nodiscard]] inline std::string IfcText(std::string_view data, std::string_view schema = "IFC4") {
  std::string text = "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('";
  text += schema;
  text +=
      "'));\nENDSEC;\nDATA;\n"
      "#1=IFCPROJECT('0000000000000000000001',$,'test',$,$,$,$,$,#2);\n"
      "#2=IFCUNITASSIGNMENT((#3,#4));\n"
      "#3=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n"
      "#4=IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.);\n";
  text += data;
  text += "\nENDSEC;\nEND-ISO-10303-21;\n";
  return text;
}

}  // namespace plumb::test
