#include "slam/io/vtk.hpp"

#include <cmath>

#include "io_test_support.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::TemporaryDirectory;
using testing::write_text;

const std::string head = "# vtk DataFile Version 3.0\na title\nASCII\nDATASET POLYDATA\n";

Cloud cloud_from(const std::string& text) {
  const TemporaryDirectory directory;
  write_text(directory / "scan.vtk", text);
  return read_vtk(directory / "scan.vtk");
}

std::string error_from(const std::string& text) {
  const TemporaryDirectory directory;
  return testing::error_in_text(directory / "scan.vtk", text, read_vtk);
}

TEST(Vtk, ReadsPointsHoweverTheirLinesAreBroken) {
  const Cloud cloud = cloud_from(head +
                                 "POINTS 3 float\n1 2 3 4\n5 6\n\n nan 8 9\nVERTICES 3 6\n1 0\n"
                                 "1 1\n1 2\n");
  ASSERT_EQ(cloud.points.size(), 3u);
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(4, 5, 6));
  EXPECT_TRUE(std::isnan(cloud.points[2].x()));
}

TEST(Vtk, SaysWhatIsWrong) {
  EXPECT_EQ(error_from("ply\n"),
            "FILE: not a legacy VTK file: it does not begin with \"# vtk DataFile Version\"");
  EXPECT_EQ(error_from("# vtk DataFile Version 3.0\nx\nBINARY\n"),
            "FILE:3: binary VTK files are not read; save it as ASCII, or as .ply");
  EXPECT_EQ(error_from(head), "FILE: there is no line POINTS in it");
  EXPECT_EQ(error_from(head + "POINTS 0 float\n"), "FILE: there are no points in it");
  EXPECT_EQ(error_from(head + "POINTS -1 float\n"), "FILE:5: there cannot be -1 points");
  EXPECT_EQ(error_from(head + "POINTS 2 float\n1 2 3 4\n"),
            "FILE: it is to have 2 points, but ends in point 2");
  EXPECT_EQ(error_from(head + "POINTS 1 float\n1 2 3 4\n"),
            "FILE:6: more numbers than the 1 points need");
  EXPECT_EQ(error_from(head + "POINTS 1 float\n1 2 x\n"), "FILE:6: expected a number, got \"x\"");
}

TEST(Vtk, ReadsTheApartment) {
  PLANUM_SHARED_DATASET(apartment, "eth_apartment");
  const Cloud cloud = read_vtk(apartment / "cloud_0.vtk");
  EXPECT_EQ(cloud.points.size(), 36674u);
  EXPECT_TRUE(cloud.points.front().isApprox(Eigen::Vector3f(-0.233432f, -0.399415f, 0.467391f)));
}

}  // namespace
}  // namespace planum
