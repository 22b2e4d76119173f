#include "labeling/rooms/opening_search.hpp"

#include <algorithm>
#include <cmath>

#include "labeling/plan/grid_morphology.hpp"

namespace planum {
namespace {

/// How often each cell of a face was hit and passed.
struct FaceImage {
  double begin = 0, bottom = 0, cell = 0;
  int columns = 0, rows = 0;
  std::vector<std::uint32_t> hits, crossings;

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  void count(std::span<const FaceSample> samples, std::vector<std::uint32_t>& counts) const {
    for (const FaceSample& s : samples) {
      const int column = static_cast<int>(std::floor((double{s.along} - begin) / cell));
      const int row = static_cast<int>(std::floor((double{s.height} - bottom) / cell));
      if (column >= 0 && row >= 0 && column < columns && row < rows) ++counts[index(column, row)];
    }
  }
};

/// The cells of an opening and what surrounds them.
struct OpeningCells {
  int left = 0, right = 0, bottom = 0, top = 0;  // inclusive
  std::size_t count = 0;
};

/// Height of a surface in front of the middle of a face; `fallback` where it is not known.
double height_before(const WallFace& face, const FloorGrid& grid, const LevelSurface& surface,
                     double fallback) {
  std::vector<float> heights;
  for (double along = face.begin; along <= face.end; along += grid.cell) {
    const std::ptrdiff_t cell = grid.find(face.at(along) + 0.2 * face.normal);
    if (cell < 0) continue;
    const float height = surface.nearest[static_cast<std::size_t>(cell)];
    if (!std::isnan(height)) heights.push_back(height);
  }
  if (heights.empty()) return fallback;
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return double{*middle};
}

/// One face at a time: image, mask of what is open, components, frame.
class FaceSearch {
 public:
  FaceSearch(const WallFace& face, std::size_t index, double floor, double ceiling,
             const OpeningSearchParams& params)
      : index_(index), floor_(floor), ceiling_(ceiling), params_(params) {
    image_.begin = face.begin - params.frame_reach;
    image_.bottom = floor;
    image_.cell = params.cell;
    image_.columns =
        static_cast<int>(std::ceil((face.length() + 2 * params.frame_reach) / params.cell));
    image_.rows = static_cast<int>(std::ceil((ceiling - floor) / params.cell));
  }

  void run(std::span<const FaceSample> hits, std::span<const FaceSample> crossings,
           std::vector<FaceOpening>& found) {
    if (image_.columns < 1 || image_.rows < 1) return;
    const std::size_t cells =
        static_cast<std::size_t>(image_.columns) * static_cast<std::size_t>(image_.rows);
    image_.hits.assign(cells, 0);
    image_.crossings.assign(cells, 0);
    image_.count(hits, image_.hits);
    image_.count(crossings, image_.crossings);
    const CellComponents parts = connected_components(open_cells(), image_.columns, image_.rows);
    for (const OpeningCells& cells_of : rectangles(parts))
      if (large_enough(cells_of)) found.push_back(described(cells_of));
  }

 private:
  CellMask open_cells() const {
    CellMask open(image_.hits.size());
    for (std::size_t i = 0; i < open.size(); ++i)
      open[i] = image_.crossings[i] > 0 && image_.crossings[i] >= image_.hits[i];
    CellMask result = closed(open, image_.columns, image_.rows, params_.fill_radius / params_.cell);
    for (std::size_t i = 0; i < open.size(); ++i)
      if (image_.hits[i] > 0 && !open[i]) result[i] = 0;
    return result;
  }

  /// Limits of each component without its spurs: columns and rows at least half as full as the
  /// fullest.
  std::vector<OpeningCells> rectangles(const CellComponents& parts) const {
    const std::size_t count = parts.sizes.size();
    const auto columns = static_cast<std::size_t>(image_.columns);
    const auto rows = static_cast<std::size_t>(image_.rows);
    std::vector<std::vector<int>> in_column(count, std::vector<int>(columns, 0));
    std::vector<std::vector<int>> in_row(count, std::vector<int>(rows, 0));
    for (std::size_t i = 0; i < parts.of_cell.size(); ++i) {
      if (parts.of_cell[i] < 0) continue;
      const auto part = static_cast<std::size_t>(parts.of_cell[i]);
      ++in_column[part][i % columns];
      ++in_row[part][i / columns];
    }
    std::vector<OpeningCells> result(count);
    for (std::size_t p = 0; p < count; ++p) {
      result[p].count = parts.sizes[p];
      std::tie(result[p].left, result[p].right) = half_full(in_column[p]);
      std::tie(result[p].bottom, result[p].top) = half_full(in_row[p]);
    }
    return result;
  }

  static std::pair<int, int> half_full(const std::vector<int>& counts) {
    const int fullest = *std::max_element(counts.begin(), counts.end());
    const auto enough = [&](int n) { return 2 * n >= fullest; };
    const auto first = std::find_if(counts.begin(), counts.end(), enough);
    const auto last = std::find_if(counts.rbegin(), counts.rend(), enough);
    return {static_cast<int>(first - counts.begin()), static_cast<int>(counts.rend() - last) - 1};
  }

  bool large_enough(const OpeningCells& c) const {
    const double width = (c.right - c.left + 1) * params_.cell;
    const double height = (c.top - c.bottom + 1) * params_.cell;
    const double area = (c.right - c.left + 1.0) * (c.top - c.bottom + 1.0);
    return width >= params_.min_width && height >= params_.min_height &&
           static_cast<double>(c.count) >= params_.min_fill * area;
  }

  bool wall_between(int left, int right, int bottom, int top) const {
    for (int row = std::max(bottom, 0); row <= std::min(top, image_.rows - 1); ++row)
      for (int column = std::max(left, 0); column <= std::min(right, image_.columns - 1);
           ++column) {
        const std::size_t i = image_.index(column, row);
        if (image_.hits[i] > image_.crossings[i]) return true;
      }
    return false;
  }

  FaceOpening described(const OpeningCells& c) const {
    const int reach = static_cast<int>(std::round(params_.frame_reach / params_.cell));
    int left = 0, right = 0, above = 0, below = 0;
    for (int row = c.bottom; row <= c.top; ++row) {
      left += wall_between(c.left - reach, c.left, row, row);
      right += wall_between(c.right, c.right + reach, row, row);
    }
    for (int column = c.left; column <= c.right; ++column) {
      above += wall_between(column, column, c.top, image_.rows);
      below += wall_between(column, column, 1, c.bottom);
    }
    const double rows = c.top - c.bottom + 1, columns = c.right - c.left + 1;
    FaceOpening opening;
    opening.face = index_;
    opening.begin = image_.begin + c.left * params_.cell;
    opening.end = image_.begin + (c.right + 1) * params_.cell;
    opening.bottom = image_.bottom + c.bottom * params_.cell;
    opening.top = image_.bottom + (c.top + 1) * params_.cell;
    opening.floor = floor_;
    opening.ceiling = ceiling_;
    opening.parapet = static_cast<double>(below) / columns;
    opening.frame = {left >= params_.min_frame * rows, right >= params_.min_frame * rows,
                     above >= params_.min_frame * columns};
    return opening;
  }

  std::size_t index_;
  double floor_, ceiling_;
  const OpeningSearchParams& params_;
  FaceImage image_;
};

}  // namespace

std::vector<FaceOpening> find_face_openings(const std::vector<WallFace>& faces,
                                            const FaceSamples& samples, const FloorGrid& grid,
                                            const LevelSurface& floor, const LevelSurface& ceiling,
                                            const OpeningSearchParams& params) {
  std::vector<FaceOpening> found;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const double top = height_before(faces[f], grid, ceiling, 0);
    const double bottom = height_before(faces[f], grid, floor, top - 2.5);
    FaceSearch(faces[f], f, bottom, top, params)
        .run(samples_of_face(samples.hits, f), samples_of_face(samples.crossings, f), found);
  }
  return found;
}

}  // namespace planum
