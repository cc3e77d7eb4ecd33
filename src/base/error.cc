// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <algorithm>
#include <utility>

#include "base/printable.h"

namespace nacre {
namespace {

// The Levenshtein distance of two words.
size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({substituted, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

Error::Error(ExitCode code, std::vector<Fault> faults) : code_(code), faults_(std::move(faults)) {
  for (Fault& fault : faults_) {
    // Text from files is shortened by the callers (base/excerpt.h). This limit is for those that
    // forget.
    constexpr size_t kLongestPart = 2000;
    for (std::string* part : {&fault.what, &fault.hint}) {
      if (part->size() > kLongestPart) *part = part->substr(0, kLongestPart) + "...";
    }
    if (!message_.empty()) message_ += '\n';
    message_ += "error: ";
    if (!fault.where.empty()) message_ += Printable(fault.where) + ": ";
    message_ += Printable(fault.what);
    if (!fault.hint.empty()) message_ += "\n  hint: " + Printable(fault.hint);
  }
}

Error::Error(ExitCode code, std::string where, std::string what, std::string hint)
    : Error(code, {Fault{std::move(where), std::move(what), std::move(hint)}}) {}

std::string NearestName(const std::string& word, const std::vector<std::string>& candidates) {
  // Names from untrusted files may be megabytes long, and the time grows with the product of two
  // lengths.
  constexpr size_t kLongest = 100;
  std::string nearest;
  if (word.size() > kLongest) return nearest;
  size_t best = std::max<size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    if (candidate.size() >= word.size() + best || word.size() >= candidate.size() + best) continue;
    const size_t distance = EditDistance(word, candidate);
    if (distance < best) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string NearestHint(const std::string& word, const std::vector<std::string>& candidates,
                        const std::string& otherwise) {
  const std::string nearest = NearestName(word, candidates);
  return nearest.empty() ? otherwise : "did you mean \"" + nearest + "\"?";
}

}  // namespace nacre
