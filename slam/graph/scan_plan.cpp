#include "slam/graph/scan_plan.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <unordered_map>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

/// What lies on a wall's cell, beside it, and where the other scan looked through.
constexpr std::int8_t on_wall = 3, beside_wall = 2, seen_free = -2;
constexpr double most_wall_tilt = radians(20);   ///< of a normal against the horizontal
constexpr double most_floor_tilt = radians(15);  ///< of a normal against the vertical
constexpr double eye_level = 0.25;               ///< m above and below the scanner
constexpr double storey = 0.25;                  ///< m of height that count once in a column
constexpr std::int16_t most_weight = 4;
constexpr std::size_t free_rays = 6000;

int cell_of(float x) {
  return static_cast<int>(std::floor(x / static_cast<float>(ScanPlan::cell) + 0.5f)) +
         ScanPlan::half_width;
}

bool inside(int column, int row) {
  return column >= 0 && column < ScanPlan::width && row >= 0 && row < ScanPlan::width;
}

std::size_t at(int column, int row) {
  return static_cast<std::size_t>(row) * ScanPlan::width + static_cast<std::size_t>(column);
}

/// A whole turn cut into parts; the middle of part 0 is at 0.
int part_of_turn(double angle, int parts) {
  const int part = static_cast<int>(std::lround(angle / (2 * pi) * parts)) % parts;
  return part < 0 ? part + parts : part;
}

/// Columns of wall points by cell and facing.
std::vector<ScanPlan::Wall> walls_of(const MatchingScan& scan, const Eigen::Matrix3f& turn) {
  struct Column {
    Eigen::Vector2f sum = Eigen::Vector2f::Zero(), facing = Eigen::Vector2f::Zero();
    float count = 0;
    std::uint64_t storeys = 0;
    bool at_eye_level = false;
  };
  std::unordered_map<std::uint32_t, std::size_t> places;
  std::vector<Column> columns;
  const float most_sine = static_cast<float>(std::sin(most_wall_tilt));
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (!scan.planes[i].known()) continue;
    const Eigen::Vector3f normal = turn * scan.planes[i].normal;
    if (std::abs(normal.z()) > most_sine) continue;
    const Eigen::Vector3f point = turn * scan.points[i];
    const int column = cell_of(point.x()), row = cell_of(point.y());
    if (!inside(column, row)) continue;
    const int facing = part_of_turn(std::atan2(normal.y(), normal.x()), ScanPlan::facings);
    const auto key = static_cast<std::uint32_t>(at(column, row) * ScanPlan::facings) +
                     static_cast<std::uint32_t>(facing);
    const auto [place, fresh] = places.try_emplace(key, columns.size());
    if (fresh) columns.emplace_back();
    Column& c = columns[place->second];
    c.sum += point.head<2>();
    c.facing += normal.head<2>();
    c.count += 1;
    const int height = static_cast<int>(std::floor(point.z() / static_cast<float>(storey)));
    c.storeys |= std::uint64_t{1} << (std::clamp(height, -32, 31) + 32);
    c.at_eye_level = c.at_eye_level || std::abs(point.z()) < static_cast<float>(eye_level);
  }
  std::vector<ScanPlan::Wall> walls;
  for (const Column& c : columns) {
    const int storeys = std::popcount(c.storeys);
    if (c.count < 2) continue;
    walls.push_back({.position = c.sum / c.count,
                     .azimuth = std::atan2(c.facing.y(), c.facing.x()),
                     .weight = static_cast<std::int16_t>(std::min<int>(storeys, most_weight)),
                     .at_eye_level = c.at_eye_level});
  }
  return walls;
}

/// A weight spread over a bin and its neighbours, as a small bell.
template <typename Bins>
void add_smoothly(Bins& bins, int bin, float weight, bool wraps) {
  constexpr std::array<float, 5> bell = {0.25f, 0.75f, 1.0f, 0.75f, 0.25f};
  const int size = static_cast<int>(bins.size());
  for (int k = -2; k <= 2; ++k) {
    int b = bin + k;
    if (wraps) b = (b % size + size) % size;
    if (b >= 0 && b < size)
      bins[static_cast<std::size_t>(b)] += weight * bell[static_cast<std::size_t>(k + 2)];
  }
}

void normalize(std::span<float> bins) {
  float squares = 0;
  for (const float b : bins) squares += b * b;
  if (squares > 0)
    for (float& b : bins) b /= std::sqrt(squares);
}

void add_levels(const MatchingScan& scan, const Eigen::Matrix3f& turn, ScanPlan& plan) {
  const float least = static_cast<float>(std::cos(most_floor_tilt));
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const float facing = turn.row(2).dot(scan.planes[i].normal);
    if (std::abs(facing) < least) continue;
    const float z = turn.row(2).dot(scan.points[i]);
    const int bin = static_cast<int>(std::floor(z / static_cast<float>(ScanPlan::level))) +
                    ScanPlan::levels / 2;
    add_smoothly(plan.level_shares[facing > 0 ? 0 : 1], bin, 1, false);
  }
  for (auto& side : plan.level_shares) {
    for (float& b : side) b = std::sqrt(b);  // large floors should not drown all else
    normalize(side);
  }
}

void add_free(const MatchingScan& scan, const Eigen::Matrix3f& turn, ScanPlan& plan) {
  plan.free.assign(static_cast<std::size_t>(ScanPlan::width) * ScanPlan::width, 0);
  for (const std::uint32_t i : scan.selection(free_rays)) {
    const Eigen::Vector3f end = turn * scan.points[i];
    const float way = end.head<2>().norm(), height = std::abs(end.z());
    if (way < 0.5f) continue;
    float last = way - 0.3f;
    if (height > eye_level) last = std::min(last, way * static_cast<float>(eye_level) / height);
    const Eigen::Vector2f along = end.head<2>() / way;
    for (float s = 0; s < last; s += static_cast<float>(ScanPlan::cell)) {
      const int column = cell_of(s * along.x()), row = cell_of(s * along.y());
      if (!inside(column, row)) break;
      plan.free[at(column, row)] = seen_free;
    }
  }
  // Not beside a wall: a little off is no contradiction.
  for (const ScanPlan::Wall& wall : plan.walls)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int column = cell_of(wall.position.x()) + dx, row = cell_of(wall.position.y()) + dy;
        if (inside(column, row)) plan.free[at(column, row)] = 0;
      }
}

void add_near_walls(ScanPlan& plan) {
  for (auto& facing : plan.near_wall)
    facing.assign(static_cast<std::size_t>(ScanPlan::width) * ScanPlan::width, 0);
  for (const ScanPlan::Wall& wall : plan.walls)
    for (int f = 0; f < ScanPlan::facings; ++f) {
      const double off = std::remainder(wall.azimuth - 2 * pi * f / ScanPlan::facings, 2 * pi);
      if (std::abs(off) > radians(40)) continue;
      auto& cells = plan.near_wall[static_cast<std::size_t>(f)];
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const int column = cell_of(wall.position.x()) + dx, row = cell_of(wall.position.y()) + dy;
          if (!inside(column, row)) continue;
          std::int8_t& value = cells[at(column, row)];
          value = std::max(value, dx == 0 && dy == 0 ? on_wall : beside_wall);
        }
    }
}

void check(const PlanMatchParams& params) {
  const auto require = [](bool good, const char* option, auto value, const char* limit) {
    if (!good) throw Error(fmt::format("scan plan: {} must be {}, got {}", option, limit, value));
  };
  require(params.max_distance > 0 && params.max_distance <= 32, "max_distance", params.max_distance,
          "above 0, at most 32 m");
  require(params.least_facing >= 0 && params.least_facing <= 1, "least_facing", params.least_facing,
          "between 0 and 1");
  // Sums of 16 bits must do.
  require(params.max_walls >= 1 && params.max_walls <= 2000, "max_walls", params.max_walls,
          "between 1 and 2000");
}

/// How well facings go together when the source is turned by so many bins.
std::vector<float> facing_agreement(const ScanPlan& source, const ScanPlan& target) {
  std::vector<float> result(ScanPlan::azimuths, 0);
  for (std::size_t turn = 0; turn < result.size(); ++turn)
    for (std::size_t b = 0; b < result.size(); ++b)
      result[turn] += source.facing_shares[b] * target.facing_shares[(b + turn) % result.size()];
  return result;
}

/// Turns about up to be tried, rad.
std::vector<double> directions(const ScanPlan& source, const ScanPlan& target,
                               const PlanMatchParams& params) {
  std::vector<float> agreement = facing_agreement(source, target);
  const float best = *std::max_element(agreement.begin(), agreement.end());
  std::vector<double> result;
  if (best <= 0) return result;
  constexpr int apart = 2;  // bins
  while (result.size() < params.max_directions) {
    const auto most = std::max_element(agreement.begin(), agreement.end());
    if (*most < params.least_facing * best) break;
    const int bin = static_cast<int>(most - agreement.begin());
    result.push_back(2 * pi * bin / ScanPlan::azimuths);
    for (int k = -apart; k <= apart; ++k)
      agreement[static_cast<std::size_t>((bin + k + ScanPlan::azimuths) % ScanPlan::azimuths)] = -1;
  }
  return result;
}

/// How much higher the source's scanner is, m.
double climb(const ScanPlan& source, const ScanPlan& target) {
  constexpr int most = 60;
  double best = 0;
  int best_shift = 0;
  for (int k = 0; k <= 2 * most; ++k) {
    const int shift = k % 2 == 0 ? k / 2 : -(k + 1) / 2;  // small ones first
    double sum = 0;
    for (std::size_t side = 0; side < 2; ++side)
      for (int b = std::max(0, -shift); b < std::min(ScanPlan::levels, ScanPlan::levels - shift);
           ++b)
        sum += source.level_shares[side][static_cast<std::size_t>(b)] *
               target.level_shares[side][static_cast<std::size_t>(b + shift)];
    if (sum <= best * 1.001) continue;
    best = sum;
    best_shift = shift;
  }
  return best_shift * ScanPlan::level;
}

/// The scores of all shifts of a turned source.
class ShiftScores {
 public:
  explicit ShiftScores(int reach)
      : reach_(reach), side_(2 * reach + 1), sums_(static_cast<std::size_t>(side_ * side_)) {}

  void clear() { std::fill(sums_.begin(), sums_.end(), std::int16_t{0}); }

  void add(const std::vector<std::int8_t>& cells, int column, int row, std::int16_t weight) {
    const int first = std::max(-reach_, -column);
    const int last = std::min(reach_, ScanPlan::width - 1 - column);
    if (first > last) return;
    const auto count = static_cast<std::size_t>(last - first + 1);
    for (int dy = std::max(-reach_, -row); dy <= std::min(reach_, ScanPlan::width - 1 - row);
         ++dy) {
      const std::int8_t* const from = cells.data() + at(column + first, row + dy);
      std::int16_t* const to =
          sums_.data() + static_cast<std::ptrdiff_t>((dy + reach_) * side_ + first + reach_);
      for (std::size_t k = 0; k < count; ++k)
        to[k] = static_cast<std::int16_t>(to[k] + weight * from[k]);
    }
  }

  /// Calls body(dx, dy, sum) for each maximum among its neighbours.
  template <typename Body>
  void for_each_maximum(int least, const Body& body) const {
    for (int y = 1; y + 1 < side_; ++y)
      for (int x = 1; x + 1 < side_; ++x) {
        const int here = y * side_ + x;
        const int sum = sums_[static_cast<std::size_t>(here)];
        if (sum < least || sum <= 0) continue;
        bool highest = true;
        for (const int beside :
             {-side_ - 1, -side_, -side_ + 1, -1, 1, side_ - 1, side_, side_ + 1})
          highest = highest && sums_[static_cast<std::size_t>(here + beside)] <= sum;
        if (highest) body(x - reach_, y - reach_, sum);
      }
  }

 private:
  int reach_, side_;
  std::vector<std::int16_t> sums_;
};

struct Found {
  double direction;
  int dx, dy, sum;
};

/// Best first, those near a better one left out.
std::vector<Found> distinct(std::vector<Found> all, std::size_t most) {
  std::stable_sort(all.begin(), all.end(),
                   [](const Found& a, const Found& b) { return a.sum > b.sum; });
  std::vector<Found> result;
  for (const Found& f : all) {
    if (result.size() >= most) break;
    const bool known = std::any_of(result.begin(), result.end(), [&](const Found& r) {
      return std::abs(std::remainder(r.direction - f.direction, 2 * pi)) < radians(8) &&
             std::hypot(r.dx - f.dx, r.dy - f.dy) < 2.5;
    });
    if (!known) result.push_back(f);
  }
  return result;
}

}  // namespace

Eigen::Matrix3d level_from_scan(const MatchingScan& scan) {
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  for (const double cone : {20.0, 10.0, 5.0}) {
    const double least = std::cos(radians(cone));
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::size_t count = 0;
    for (const LocalPlane& plane : scan.planes) {
      const Eigen::Vector3d normal = plane.normal.cast<double>();
      const double cosine = normal.dot(up);
      if (std::abs(cosine) < least) continue;
      sum += cosine > 0 ? normal : Eigen::Vector3d(-normal);
      ++count;
    }
    if (count < scan.points.size() / 20 || count == 0) break;
    up = sum.normalized();
  }
  return turn_between(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

ScanPlan scan_plan(const MatchingScan& scan) {
  ScanPlan plan;
  plan.level_from_scan = level_from_scan(scan);
  const Eigen::Matrix3f turn = plan.level_from_scan.cast<float>();
  plan.walls = walls_of(scan, turn);
  for (const ScanPlan::Wall& wall : plan.walls)
    add_smoothly(plan.facing_shares, part_of_turn(wall.azimuth, ScanPlan::azimuths),
                 static_cast<float>(wall.weight), true);
  normalize(plan.facing_shares);
  add_levels(scan, turn, plan);
  add_near_walls(plan);
  add_free(scan, turn, plan);
  return plan;
}

std::vector<PlanMatch> matches_of_plans(const ScanPlan& source, const ScanPlan& target,
                                        const PlanMatchParams& params) {
  check(params);
  const std::size_t step = 1 + source.walls.size() / params.max_walls;
  const double height = climb(source, target);
  const bool same_eye_level = std::abs(height) < eye_level;
  ShiftScores scores(static_cast<int>(std::ceil(params.max_distance / ScanPlan::cell)));
  std::vector<Found> all;
  int most = 0, best = 0;
  for (std::size_t w = 0; w < source.walls.size(); w += step)
    most += on_wall * source.walls[w].weight;
  for (const double direction : directions(source, target, params)) {
    scores.clear();
    const Eigen::Matrix2f turn =
        Eigen::Rotation2Df(static_cast<float>(direction)).toRotationMatrix();
    for (std::size_t w = 0; w < source.walls.size(); w += step) {
      const ScanPlan::Wall& wall = source.walls[w];
      const Eigen::Vector2f place = turn * wall.position;
      const int column = cell_of(place.x()), row = cell_of(place.y());
      const int facing = part_of_turn(wall.azimuth + direction, ScanPlan::facings);
      scores.add(target.near_wall[static_cast<std::size_t>(facing)], column, row, wall.weight);
      if (wall.at_eye_level && same_eye_level) scores.add(target.free, column, row, wall.weight);
    }
    scores.for_each_maximum(best / 2, [&](int dx, int dy, int sum) {
      all.push_back({direction, dx, dy, sum});
      best = std::max(best, sum);
    });
  }
  std::vector<PlanMatch> result;
  for (const Found& f : distinct(std::move(all), params.max_matches)) {
    Pose level = pose_from_xyz_ypr({f.dx * ScanPlan::cell, f.dy * ScanPlan::cell, height},
                                   f.direction, 0, 0);
    Pose pose = Pose::Identity();
    pose.linear() = target.level_from_scan.transpose() * level.linear() * source.level_from_scan;
    pose.translation() = target.level_from_scan.transpose() * level.translation();
    result.push_back({pose, static_cast<double>(f.sum) / most});
  }
  return result;
}

}  // namespace planum
