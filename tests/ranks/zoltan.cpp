// Parts of weighted points by Zoltan, by one process.
//   zoltan METHOD PARTS < points
// reads x y z weight of each point, and writes the number of its part, from 0.
#include <array>
#include <iostream>
#include <vector>

#include <mpi.h>
#include <zoltan_cpp.h>

namespace {

using Points = std::vector<std::array<double, 4>>;

int count(void* points, int* error) {
  *error = ZOLTAN_OK;
  return static_cast<int>(static_cast<Points*>(points)->size());
}

int three(void*, int* error) {
  *error = ZOLTAN_OK;
  return 3;
}

void list(void* points, int, int, ZOLTAN_ID_PTR global, ZOLTAN_ID_PTR local, int, float* weights,
          int* error) {
  const auto& all = *static_cast<Points*>(points);
  for (std::size_t k = 0; k < all.size(); ++k) {
    global[k] = local[k] = static_cast<ZOLTAN_ID_TYPE>(k);
    weights[k] = static_cast<float>(all[k][3]);
  }
  *error = ZOLTAN_OK;
}

void places(void* points, int, int, int number, ZOLTAN_ID_PTR global, ZOLTAN_ID_PTR, int dimension,
            double* to, int* error) {
  const auto& all = *static_cast<Points*>(points);
  for (int k = 0; k < number; ++k)
    for (int a = 0; a < dimension; ++a)
      to[k * dimension + a] = all[global[k]][static_cast<std::size_t>(a)];
  *error = ZOLTAN_OK;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  float version = 0.0F;
  Zoltan_Initialize(argc, argv, &version);
  Points points;
  for (std::array<double, 4> p; std::cin >> p[0] >> p[1] >> p[2] >> p[3];) points.push_back(p);
  {
    Zoltan zoltan(MPI_COMM_WORLD);
    zoltan.Set_Param("DEBUG_LEVEL", "0");
    zoltan.Set_Param("LB_METHOD", argv[1]);
    zoltan.Set_Param("NUM_GLOBAL_PARTS", argv[2]);
    zoltan.Set_Param("OBJ_WEIGHT_DIM", "1");
    zoltan.Set_Param("IMBALANCE_TOL", "1.01");
    zoltan.Set_Param("RETURN_LISTS", "PARTS");
    zoltan.Set_Num_Obj_Fn(count, &points);
    zoltan.Set_Obj_List_Fn(list, &points);
    zoltan.Set_Num_Geom_Fn(three, &points);
    zoltan.Set_Geom_Multi_Fn(places, &points);
    int changes = 0, globals = 0, locals = 0, in = 0, out = 0;
    ZOLTAN_ID_PTR in_global, in_local, out_global, out_local;
    int *from, *into, *to, *part;
    zoltan.LB_Partition(changes, globals, locals, in, in_global, in_local, from, into, out,
                        out_global, out_local, to, part);
    std::vector<int> parts(points.size(), 0);
    for (int k = 0; k < out; ++k) parts[out_global[k]] = part[k];
    for (const int p : parts) std::cout << p << '\n';
  }
  MPI_Finalize();
  return points.empty() ? 1 : 0;
}
