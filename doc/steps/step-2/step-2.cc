// Cut a disc with the cells of a mesh, and integrate with the pieces. Needs the geometry library alone: no fluid, no
// contacts.
//
//   step-2 pieces.csv crossing.csv
//
// writes the pieces of one disc, and the void fraction of a cell while the disc crosses its side; prints how exact the
// pieces are.

#include <alluvium/geometry/disc_polygon_overlap.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

using namespace alluvium::geometry;

// The unit square in n x n quadrilaterals whose inner vertices are shifted, so that no side is parallel to another: a
// mesh as it comes from a mesh generator. `shift` is in cell sizes; below 0.25 all cells stay convex.
class Mesh
{
public:
  Mesh(const unsigned n, const double shift)
  {
    for (unsigned j = 0; j < n; ++j)
      for (unsigned i = 0; i < n; ++i)
        {
          // Vertices counter-clockwise. What a cell costs to prepare is paid once a mesh, not once a grain.
          ConvexPolygon polygon;
          polygon.vertex = {{vertex(i, j, n, shift),
                             vertex(i + 1, j, n, shift),
                             vertex(i + 1, j + 1, n, shift),
                             vertex(i, j + 1, n, shift)}};
          cells.emplace_back(polygon);
        }
  }

  std::vector<PreparedPolygon> cells;

private:
  static Point2 vertex(const unsigned i, const unsigned j, const unsigned n, const double shift)
  {
    const bool   inside = i > 0 && i < n && j > 0 && j < n;
    const double angle  = 2.4 * i + 5.1 * j; // any numbers will do
    const double s      = inside ? shift : 0.;
    return {{(i + s * std::cos(angle)) / n, (j + s * std::sin(angle)) / n}};
  }
};

// All pieces of a disc. Cells that it does not touch give an area of zero. (The program finds the cells near a grain by
// a search; here there are few, and all are tried.)
std::vector<Overlap> pieces_of(const Disc &disc, const Mesh &mesh)
{
  std::vector<Overlap> pieces;
  for (const PreparedPolygon &cell : mesh.cells)
    pieces.push_back(overlap(disc, cell));
  return pieces;
}

// The integral of a function over the disc, piece by piece. The rule evaluates it at the centroid of each piece: exact
// for linear functions.
template <typename Function>
double integrate(const std::vector<Overlap> &pieces, const Function &f)
{
  double sum = 0.;
  for (const Overlap &piece : pieces)
    if (piece.area > 0.)
      sum += piece.area * f(piece.centroid[0], piece.centroid[1]);
  return sum;
}

// The function x y is in the space of bilinear finite elements, but not linear. With c the centroid, its mean over a
// piece is c_x c_y plus the mean of (x - c_x) (y - c_y), which is the mixed second moment.
double integrate_xy(const std::vector<Overlap> &pieces)
{
  double sum = 0.;
  for (const Overlap &piece : pieces)
    sum += piece.area * piece.centroid[0] * piece.centroid[1] + piece.second_moments[1];
  return sum;
}

void print_exactness(const Disc &disc)
{
  const double pi = std::acos(-1.), r = disc.radius, x = disc.centre[0], y = disc.centre[1];
  const double area = pi * r * r;

  std::printf("h/d  pieces  area     x        x y      x y with moments  x^2\n");
  for (const unsigned n : {4, 8, 16, 32, 64})
    {
      const Mesh mesh(n, 0.2);
      const auto pieces   = pieces_of(disc, mesh);
      unsigned   n_pieces = 0;
      for (const Overlap &piece : pieces)
        n_pieces += piece.area > 0.;

      // relative errors; over a disc the mean of x^2 is x_0^2 + r^2/4
      const double errors[] = {
        integrate(pieces, [](double, double) { return 1.; }) / area - 1.,
        integrate(pieces, [](double X, double) { return X; }) / (area * x) - 1.,
        integrate(pieces, [](double X, double Y) { return X * Y; }) / (area * x * y) - 1.,
        integrate_xy(pieces) / (area * x * y) - 1.,
        integrate(pieces, [](double X, double) { return X * X; }) / (area * (x * x + r * r / 4.)) - 1.};
      std::printf("%-4.2f %-7u", 1. / n / (2. * r), n_pieces);
      for (const double error : errors)
        std::printf(" %-8.1e", std::abs(error));
      std::printf("\n");
    }
}

void write_pieces(const Disc &disc, const char *name)
{
  const Mesh mesh(6, 0.2);
  const auto pieces = pieces_of(disc, mesh);
  std::FILE *file   = std::fopen(name, "w");
  std::fprintf(file, "x0,y0,x1,y1,x2,y2,x3,y3,area,cell_area,cx,cy\n");
  for (unsigned c = 0; c < pieces.size(); ++c)
    {
      for (unsigned v = 0; v < 4; ++v)
        std::fprintf(file, "%.6f,%.6f,", mesh.cells[c].x[v], mesh.cells[c].y[v]);
      std::fprintf(file,
                   "%.8g,%.8g,%.8g,%.8g\n",
                   pieces[c].area,
                   mesh.cells[c].area,
                   pieces[c].centroid[0],
                   pieces[c].centroid[1]);
    }
  std::fclose(file);
}

// A disc crosses the side between two cells. Its area in the right one, exactly, and as a method has it that puts all
// of a grain into the cell of its centre.
double write_crossing(const double r, const char *name)
{
  const Mesh   mesh(2, 0.); // squares of one half: cell 0 is lower left, cell 1 right of it
  const double disc_area = std::acos(-1.) * r * r;
  double       steepest = 0., before = 0.;
  std::FILE   *file = std::fopen(name, "w");
  std::fprintf(file, "x,exact,centre\n");
  for (unsigned i = 0; i <= 200; ++i)
    {
      const Disc   disc{{{0.5 + 2. * r * (i / 100. - 1.), 0.25}}, r};
      const double exact  = 1. - overlap(disc, mesh.cells[1]).area / mesh.cells[1].area;
      const double centre = 1. - (disc.centre[0] > 0.5 ? disc_area : 0.) / mesh.cells[1].area;
      std::fprintf(file, "%.6f,%.8f,%.8f\n", (disc.centre[0] - 0.5) / (2. * r), exact, centre);
      if (i > 0)
        steepest = std::fmax(steepest, std::abs(exact - before));
      before = exact;
    }
  std::fclose(file);
  return steepest / (disc_area / mesh.cells[1].area);
}

int main(const int argc, const char **argv)
{
  if (argc != 3)
    {
      std::fprintf(stderr, "step-2 pieces.csv crossing.csv\n");
      return 1;
    }
  const Disc disc{{{0.47, 0.54}}, 0.125};
  print_exactness(disc);
  write_pieces({{{0.47, 0.54}}, 0.31}, argv[1]);
  std::printf("largest change of the void fraction in a move of d/100, over that when all of the disc enters: %.4f\n",
              write_crossing(0.1, argv[2]));
}
