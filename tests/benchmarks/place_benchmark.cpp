// Places recognized without poses: on simulated buildings and on the data beside the project.
// How well free space tells right poses from wrong ones; how often the places most like a scan's
// overlap it; how many consecutive pairs are located from no guess; false answers; times.
//
// usage: place_benchmark [SCENE [free-space]]   SCENE: a part of the name of those to take
// PLACES_VERBOSE in the environment: also list what was wrong or not sure.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "slam/graph/place_search.hpp"
#include "slam/graph/scan_descriptor.hpp"
#include "slam/graph/scan_plan.hpp"
#include "slam/registration/icp.hpp"
#include "slam/registration/overlap.hpp"
#include "slam/registration/see_through.hpp"
#include "tests/benchmarks/place_scenes.hpp"
#include "tests/slam/registration/simulated_room.hpp"

namespace {

using namespace planum;
using testing::Scene;

double wall_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// s, of this thread alone: other programs do not count.
double now() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Pose true_motion(const Scene& scene, std::size_t target, std::size_t source) {
  return scene.truth[target].inverse() * scene.truth[source];
}

double true_overlap(const Scene& scene, std::size_t target, std::size_t source) {
  const Pose pose = true_motion(scene, target, source);
  return std::min(
      estimated_overlap(scene.scans[source], scene.scans[target], pose, {.distance = 0.1}),
      estimated_overlap(scene.scans[target], scene.scans[source], pose.inverse(),
                        {.distance = 0.1}));
}

void print_distribution(const char* what, std::vector<double> values) {
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return 100 * values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  const auto above =
      std::count_if(values.begin(), values.end(), [](double v) { return v > most_contradicted; });
  fmt::print(
      "  {:34} {:5} poses: {:5.1f} {:5.1f} {:5.1f} {:5.1f} {:5.1f} {:5.1f} %, {:5.1f} % above "
      "{:.0f} %\n",
      what, values.size(), at(0), at(0.05), at(0.5), at(0.95), at(0.99), at(1),
      100.0 * static_cast<double>(above) / static_cast<double>(values.size()),
      100 * most_contradicted);
}

/// Contradicted shares (least, 5 %, median, 95 %, 99 %, most) at right poses a little off, and at
/// wrong ones that ICP ends at from anywhere with much overlap.
void print_free_space(const Scene& scene) {
  const double begin = now();
  std::vector<RangeView> views;
  for (const MatchingScan& scan : scene.scans) views.push_back(range_view(scan));
  const double made = now() - begin;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < scene.scans.size(); ++a)
    for (std::size_t b = a + 1; b < scene.scans.size(); ++b) pairs.emplace_back(a, b);
  std::vector<std::vector<double>> right(pairs.size()), wrong(pairs.size());
  std::vector<double> seconds(pairs.size());
  parallel_for(pairs.size(), 1, [&](std::size_t k, std::size_t) {
    const auto [a, b] = pairs[k];
    const Pose truth = true_motion(scene, a, b);
    std::mt19937 random(static_cast<unsigned>(k));
    if (true_overlap(scene, a, b) > 0.2)
      for (int n = 0; n < 3; ++n) {
        const Pose pose = truth * testing::random_motion(random, 0.02, radians(0.5));
        const double start = now();
        right[k].push_back(check_free_space(views[b], views[a], pose).contradicted());
        seconds[k] = now() - start;
      }
    if (k % std::max<std::size_t>(1, pairs.size() / 400) != 0) return;
    std::uniform_real_distribution<double> shift(-3, 3), turn(-pi, pi);
    for (int n = 0; n < 4; ++n) {
      const Pose guess = pose_from_xyz_ypr({shift(random), shift(random), 0}, turn(random), 0, 0);
      const Alignment found = align(scene.scans[b], scene.scans[a], guess);
      if (!found.converged || found.overlap < 0.3) continue;
      const Pose off = truth.inverse() * found.target_from_source;
      if (off.translation().norm() < 0.3 && rotation_angle(off) < radians(5)) continue;
      wrong[k].push_back(
          check_free_space(views[b], views[a], found.target_from_source).contradicted());
    }
  });
  std::vector<double> all_right, all_wrong;
  double longest = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    all_right.insert(all_right.end(), right[k].begin(), right[k].end());
    all_wrong.insert(all_wrong.end(), wrong[k].begin(), wrong[k].end());
    longest = std::max(longest, seconds[k]);
  }
  print_distribution("contradicted, right poses", all_right);
  print_distribution("contradicted, wrong ICP results", all_wrong);
  fmt::print("  {:.2f} ms a view, {:.2f} ms a check at most\n",
             1000 * made / static_cast<double>(views.size()), 1000 * longest);
}

bool right(const Pose& found, const Pose& truth, double shift, double turn) {
  const Pose off = truth.inverse() * found;
  return off.translation().norm() < shift && rotation_angle(off) < turn;
}

/// Where among the matches of plans the right one is, for pairs with a lot in common.
void print_plan_matches(const Scene& scene) {
  const double begin = now();
  std::vector<ScanPlan> plans;
  for (const MatchingScan& scan : scene.scans) plans.push_back(scan_plan(scan));
  const double made = now() - begin;
  for (const auto& [low, high] : {std::pair{0.2, 0.35}, {0.35, 0.5}, {0.5, 1.0}}) {
    std::size_t pairs = 0, first = 0, five = 0, any = 0;
    double spent = 0;
    for (std::size_t a = 0; a < scene.scans.size(); ++a)
      for (std::size_t b = a + 1; b < scene.scans.size(); ++b) {
        const double overlap = true_overlap(scene, a, b);
        if (overlap < low || overlap >= high) continue;
        ++pairs;
        const double start = now();
        const auto matches = matches_of_plans(plans[b], plans[a]);
        spent += now() - start;
        for (std::size_t k = 0; k < matches.size(); ++k) {
          if (!right(matches[k].target_from_source, true_motion(scene, a, b), 0.6, radians(8)))
            continue;
          first += k == 0;
          five += k < 5;
          ++any;
          break;
        }
      }
    if (pairs > 0)
      fmt::print(
          "  plans, overlap {:.2f}-{:.2f}: {:4} pairs, right one first {:.2f}, among 5 {:.2f}, any "
          "{:.2f}; {:.1f} ms each\n",
          low, high, pairs, static_cast<double>(first) / static_cast<double>(pairs),
          static_cast<double>(five) / static_cast<double>(pairs),
          static_cast<double>(any) / static_cast<double>(pairs),
          1000 * spent / static_cast<double>(pairs));
  }
  fmt::print("  {:.2f} ms a plan\n", 1000 * made / static_cast<double>(plans.size()));
}

/// Scans in common among the most similar ones by descriptor.
void print_descriptors(const Scene& scene) {
  const double begin = now();
  std::vector<ScanDescriptor> descriptors;
  for (const MatchingScan& scan : scene.scans) descriptors.push_back(scan_descriptor(scan));
  const double made = now() - begin;
  const auto similar = similar_scans(descriptors, scene.scans.size());
  fmt::print(
      "  descriptors: {:.2f} ms each; share of pairs that overlap by 0.35 (not consecutive) among "
      "the first",
      1000 * made / static_cast<double>(scene.scans.size()));
  for (const std::size_t count : {5, 10, 20, 30}) {
    std::size_t pairs = 0, found = 0;
    for (std::size_t a = 0; a < scene.scans.size(); ++a)
      for (std::size_t b = a + 2; b < scene.scans.size(); ++b) {
        if (true_overlap(scene, a, b) < 0.35) continue;
        ++pairs;
        const auto among = [&](std::size_t x, std::size_t y) {
          const auto end =
              similar[x].begin() + static_cast<std::ptrdiff_t>(std::min(count, similar[x].size()));
          return std::any_of(similar[x].begin(), end,
                             [&](const SimilarScan& s) { return s.scan == y; });
        };
        found += among(a, b) || among(b, a);
      }
    if (pairs > 0)
      fmt::print(" {}: {:.2f}", count, static_cast<double>(found) / static_cast<double>(pairs));
  }
  fmt::print("\n");
}

/// What is found without poses: all pairs of scans are asked where one lies in the other.
void print_located(const Scene& scene, const std::vector<Place>& places) {
  struct Answer {
    std::size_t target, source;
    double overlap, seconds;
    bool found, right;
    std::string reason;
  };
  std::vector<Answer> answers;
  for (std::size_t a = 0; a < places.size(); ++a)
    for (std::size_t b = a + 1; b < places.size(); ++b) {
      const double overlap = true_overlap(scene, a, b);
      // All consecutive pairs, and some of the others.
      if (b == a + 1 || (a * 31 + b * 17) % 16 == 0)
        answers.push_back({a, b, overlap, 0, false, false, {}});
    }
  parallel_for(answers.size(), 1, [&](std::size_t k, std::size_t) {
    Answer& answer = answers[k];
    const double begin = now();
    const Location location = locate(places[answer.source], places[answer.target]);
    answer.seconds = now() - begin;
    answer.found = location.found;
    answer.reason = location.reason;
    answer.right = right(location.alignment.target_from_source,
                         true_motion(scene, answer.target, answer.source), 0.1, radians(1.5));
  });
  const auto print = [&](const char* what, const auto& among) {
    std::size_t count = 0, found = 0, wrong = 0, unsure = 0;
    double seconds = 0;
    for (const Answer& answer : answers) {
      if (!among(answer)) continue;
      ++count;
      found += answer.found && answer.right;
      wrong += answer.found && !answer.right;
      unsure += !answer.found && answer.right;
      seconds += answer.seconds;
    }
    if (count > 0)
      fmt::print(
          "  located, {:32} {:4} pairs: {:.2f} right, {} wrong, {} right but not sure; {:.0f} ms "
          "each\n",
          what, count, static_cast<double>(found) / static_cast<double>(count), wrong, unsure,
          1000 * seconds / static_cast<double>(count));
  };
  print("consecutive, overlap over 0.35:",
        [](const Answer& a) { return a.source == a.target + 1 && a.overlap > 0.35; });
  print("consecutive, less:",
        [](const Answer& a) { return a.source == a.target + 1 && a.overlap <= 0.35; });
  print("others, overlap over 0.35:",
        [](const Answer& a) { return a.source != a.target + 1 && a.overlap > 0.35; });
  print("others, less:",
        [](const Answer& a) { return a.source != a.target + 1 && a.overlap <= 0.35; });
  if (std::getenv("PLACES_VERBOSE"))
    for (const Answer& a : answers)
      if ((a.found && !a.right) || (!a.found && a.overlap > 0.35))
        fmt::print("    {}-{} overlap {:.2f} {} {}\n", a.target, a.source, a.overlap,
                   a.found   ? "WRONG"
                   : a.right ? "right:"
                             : "",
                   a.reason);
}

/// What is proposed without poses, and how much of it is right.
void print_found(const Scene& scene, const std::vector<Place>& places) {
  const double begin = wall_clock();
  const std::clock_t worked = std::clock();
  const auto candidates = find_places(places);
  const double spent = wall_clock() - begin;
  const double work = static_cast<double>(std::clock() - worked) / CLOCKS_PER_SEC;
  std::size_t pairs = 0, found = 0, good = 0;
  const auto near_truth = [&](const PlaceCandidate& c) {
    return right(c.target_from_source, true_motion(scene, c.target, c.source), 0.6, radians(8));
  };
  for (const PlaceCandidate& c : candidates) good += near_truth(c);
  for (std::size_t a = 0; a < places.size(); ++a)
    for (std::size_t b = a + 1; b < places.size(); ++b) {
      if (true_overlap(scene, a, b) < 0.35) continue;
      ++pairs;
      found += std::any_of(candidates.begin(), candidates.end(), [&](const PlaceCandidate& c) {
        return c.target == a && c.source == b && near_truth(c);
      });
    }
  for (std::size_t k = 0; std::getenv("PLACES_VERBOSE") && k < candidates.size();
       k += 1 + candidates.size() / 20)
    fmt::print("    {} {:.2f} {}\n", k, candidates[k].score, near_truth(candidates[k]));
  std::size_t first = 0;
  const std::size_t top = std::min(candidates.size(), places.size());
  for (std::size_t k = 0; k < top; ++k) first += near_truth(candidates[k]);
  fmt::print(
      "  places: {} candidates, {} right, {} of the first {}; {} of {} pairs with overlap over "
      "0.35; {:.2f} s, {:.2f} s of work\n",
      candidates.size(), good, first, top, found, pairs, spent, work);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string wanted = argc > 1 ? argv[1] : "";
  testing::for_each_scene(wanted, [&](const Scene& scene) {
    fmt::print("{}: {} scans\n", scene.name, scene.scans.size());
    print_plan_matches(scene);
    print_descriptors(scene);
    const std::vector<Place> places = places_of(scene.scans);
    print_found(scene, places);
    print_located(scene, places);
    if (argc > 2) print_free_space(scene);
  });
}
