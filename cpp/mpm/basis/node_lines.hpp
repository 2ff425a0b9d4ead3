#pragma once
// The fields of a node lie side by side in a line, so that whoever wants a node touches one cache
// line (where walls absorb in 3D, two at most) and moves all its fields at once.

namespace mpm {

/// A line is made of quads of numbers: mass and velocity, then the force; behind them, where walls
/// absorb, the dashpots. In 2D the last of a vector's three places stays empty, or is a dashpot's.
inline constexpr int quad = 4;
inline constexpr int line = 2 * quad;  // without the dashpots of 3D
inline constexpr int mass_at = 0, velocity_at = 1, force_at = quad;
template <int D>
inline constexpr int dashpot_at = D == 2 ? force_at + D : line;
template <int D>
inline constexpr int line_with_dashpots = D == 2 ? line : line + quad;

/// Lines of nodes, or single quads of theirs, `width` numbers apart.
struct NodeLines {
  double* data;
  int width;
  double* operator[](int node) const { return data + node * width; }
  /// The same, counted from a node, or from a number of the lines.
  NodeLines from(int node) const { return {data + node * width, width}; }
  NodeLines at(int number) const { return {data + number, width}; }
};

/// One number of each line.
struct NodeField {
  double* first;
  int width;
  double& operator[](int node) const { return first[node * width]; }
};

}  // namespace mpm
