#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace timbre {

/// How well one ranking puts the relevant first; all in [0, 1].
struct RetrievalScores {
  double nearest = 0.0;            ///< NN: the first is relevant
  double first_tier = 0.0;         ///< relevant among the first C, over C
  double second_tier = 0.0;        ///< relevant among the first 2C, over C
  double e_measure = 0.0;          ///< harmonic mean of precision and recall of the first 32
  double dcg = 0.0;                ///< discounted gain 1, 1, 1/log2 3, ... over the ideal one
  double average_precision = 0.0;  ///< AP; means of it are mAP
  /// Interpolated precision at recalls 0.05, 0.1, ..., 1: the best at that recall or beyond.
  std::array<double, 20> precision = {};

  RetrievalScores& operator+=(const RetrievalScores& other);
  RetrievalScores& operator/=(double count);
};

/// Scores one query whose own shape has been taken out. C, the size of its class without
/// itself, is the number of relevant items; it must be at least 1.
///
/// Ties count against the ranking: at equal distance the irrelevant come first. NaN and
/// infinite distances rank last.
/// @throws Error  bad_request if sizes differ or nothing is relevant
[[nodiscard]] RetrievalScores score_ranking(std::span<const double> distances,
                                            const std::vector<bool>& relevant);

struct ClassScores {
  std::string label;
  std::int64_t queries = 0;
  RetrievalScores mean;
};

struct RetrievalReport {
  RetrievalScores micro;             ///< mean over queries
  RetrievalScores macro;             ///< mean over classes of each class's mean
  std::vector<ClassScores> classes;  ///< classes of two and more, by label
  std::int64_t queries = 0;          ///< shapes whose class holds another shape
  std::int64_t shapes = 0;
  std::int64_t undefined = 0;  ///< NaN or infinite distances met; more than 0 is a fault
};

/// Leave-one-out: every shape is a query once, taken out by identity, not by distance 0.
/// A shape alone in its class, or without a label (""), is no query but stays in the way.
///
/// @param labels     one per shape
/// @param distances  gives for a query the distances to all shapes, itself included;
///                   they need not be symmetric
/// @throws Error  bad_request if no class holds two shapes
/// @see Shilane et al. 2004 (NN, tiers, E, DCG)
[[nodiscard]] RetrievalReport evaluate_retrieval(
    const std::vector<std::string>& labels,
    const std::function<Eigen::VectorXd(Eigen::Index)>& distances);

}  // namespace timbre
