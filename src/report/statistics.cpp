#include "report/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace isostat {

namespace {

using Index = std::map<int, const EquilibriumRow*>;

Index by_number(const std::vector<EquilibriumRow>& rows) {
    Index index;
    for (const EquilibriumRow& row : rows) {
        index[row.number] = &row;
    }
    return index;
}

const EquilibriumRow* find(const Index& index, int number) {
    const auto found = index.find(number);
    return found == index.end() ? nullptr : found->second;
}

Increments collect(const std::vector<EquilibriumRow>& rows, std::optional<double> RearrangementRow::*which) {
    Increments increments;
    for (const RearrangementRow& one : rearrangements(rows)) {
        if (const auto& value = one.*which) {
            (one.direction > 0 ? increments.loading : increments.unloading).push_back(*value);
        }
    }
    return increments;
}

} // namespace

std::vector<RearrangementRow> rearrangements(const std::vector<EquilibriumRow>& rows) {
    const Index index = by_number(rows);
    std::vector<RearrangementRow> list;
    for (const EquilibriumRow& row : rows) {
        const EquilibriumRow* before = find(index, row.previous);
        if (before == nullptr || row.arcs == 0) {
            continue;
        }
        RearrangementRow& one = list.emplace_back();
        one.segment = row.segment;
        one.number = row.number;
        one.direction = row.ratio > before->ratio ? 1 : -1;
        one.ratio = row.ratio;
        one.arcs = row.arcs;
        if (before->segment == row.segment && before->arcs != 0 && row.ratio != before->ratio) {
            one.stress_increment = std::abs(row.ratio - before->ratio);
        }
        if (row.strain2 != before->strain2) {
            one.strain_increment = std::abs(row.strain2 - before->strain2);
        }
    }
    return list;
}

Increments stress_increments(const std::vector<EquilibriumRow>& rows) {
    return collect(rows, &RearrangementRow::stress_increment);
}

Increments strain_increments(const std::vector<EquilibriumRow>& rows) {
    return collect(rows, &RearrangementRow::strain_increment);
}

std::vector<std::pair<double, double>> complementary_distribution(std::vector<double> values) {
    std::ranges::sort(values);
    std::vector<std::pair<double, double>> points;
    const auto count = static_cast<double>(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i > 0 && values[i] == values[i - 1]) {
            continue;
        }
        points.emplace_back(values[i], (count - static_cast<double>(i)) / count);
    }
    return points;
}

std::vector<std::pair<double, double>> histogram(const std::vector<double>& values, double low, double high, int bins) {
    const double width = (high - low) / bins;
    std::vector<int> count(static_cast<std::size_t>(bins), 0);
    for (const double v : values) {
        if (v >= low && v <= high) {
            const double part = (v - low) / width; // outside every bin, or NaN, when the width is lost to rounding
            ++count[static_cast<std::size_t>(part < bins ? static_cast<int>(part) : bins - 1)];
        }
    }
    std::vector<std::pair<double, double>> points;
    points.reserve(count.size());
    for (int b = 0; b < bins; ++b) {
        points.emplace_back(low + (b + 0.5) * width,
                            count[static_cast<std::size_t>(b)] / (static_cast<double>(values.size()) * width));
    }
    return points;
}

std::vector<EquilibriumRow> path_to(const std::vector<EquilibriumRow>& rows, int number) {
    const Index index = by_number(rows);
    std::vector<EquilibriumRow> path;
    for (const EquilibriumRow* row = find(index, number); row != nullptr && path.size() < rows.size();
         row = find(index, row->previous)) {
        path.push_back(*row);
    }
    std::ranges::reverse(path);
    return path;
}

std::map<int, SegmentPath> segment_paths(const std::vector<EquilibriumRow>& rows,
                                         const std::vector<std::string>& names) {
    const Index index = by_number(rows);
    std::map<int, SegmentPath> paths;
    for (const EquilibriumRow& row : rows) {
        const auto [at, is_new] = paths.try_emplace(row.segment);
        SegmentPath& path = at->second;
        if (is_new) {
            const auto s = static_cast<std::size_t>(row.segment);
            path.title = s < names.size() ? names[s] : fmt::format("segment {}", s + 1);
            if (const EquilibriumRow* before = find(index, row.previous)) {
                path.rows.push_back(*before);
                path.has_start = true;
            }
        }
        path.rows.push_back(row);
    }
    return paths;
}

double mean(const std::vector<double>& values) {
    return values.empty() ? 0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

} // namespace isostat
