// The force of each kind of load on a piece of a surface.
#include "check.hpp"
#include "mpm/loads/surface_load.hpp"

void test_load_kinds(mpm::testing::Report& report) {
  using namespace mpm;
  SurfaceLoad<2> load;
  SurfacePiece<2> piece;
  piece.area = {3.0, -4.0};
  piece.size = 6.0;  // of two faces at an edge: more than |area|
  load.mean = {2.0, 1.0};
  load.kind = LoadKinds::id_of<Pressure>();
  CHECK(load.force_on(piece)[0] == -6.0 && load.force_on(piece)[1] == 8.0);
  load.kind = LoadKinds::id_of<Traction>();
  CHECK(load.force_on(piece)[0] == 12.0 && load.force_on(piece)[1] == 6.0);
  piece.area = {0.0, 0.0};
  piece.size = 0.5;  // carried by two particles
  load.kind = LoadKinds::id_of<PointForce>();
  CHECK(load.force_on(piece)[0] == 1.0 && load.force_on(piece)[1] == 0.5);
  CHECK(acts_at_point<PointForce> && !acts_at_point<Traction>);
  CHECK_EQUAL(word_of(LoadKinds::id_of<Traction>()), std::string_view("traction"));
}
