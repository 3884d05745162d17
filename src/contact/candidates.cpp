#include <isostat/contact/candidates.hpp>
#include <algorithm>
#include <map>
#include <cmath>
#include <limits>
namespace isostat {
template <int Dim> bool CandidateList<Dim>::covers(const Packing<Dim>& p) const {
    if (reference.size() != p.q.size()) return false;
    for (std::size_t k = 0; k < p.q.size(); k += 2) {
        const double dx = p.q[k] - reference[k], dy = p.q[k + 1] - reference[k + 1];
        if (!(2 * std::sqrt(dx * dx + dy * dy) * (1 + 1e-14) < reach)) return false;
    }
    return true;
}
template <int Dim> CandidateList<Dim> find_candidates(const Packing<Dim>& p, double fraction) {
    CandidateList<Dim> list;
    list.reach = fraction * p.min_radius();
    list.reference = p.q;
    const double cell = 2 * p.max_radius() + list.reach;
    std::map<std::pair<long, long>, std::vector<int>> grid;
    const int n = p.disk_count();
    for (int i = 0; i < n; ++i) {
        const long cx = std::lround(std::floor(p.q[2 * i] / cell)), cy = std::lround(std::floor(p.q[2 * i + 1] / cell));
        for (long a = -1; a <= 1; ++a) for (long b = -1; b <= 1; ++b) {
            auto it = grid.find({cx + a, cy + b});
            if (it == grid.end()) continue;
            for (int j : it->second) { Contact c{ContactKind::disk_disk, j, i}; if (gap(p, c) < list.reach) list.contacts.push_back(c); }
        }
        grid[{cx, cy}].push_back(i);
        for (int a = 0; a < 2; ++a) {
            if (p.walls.lower[a] != WallKind::absent) { Contact c{ContactKind::lower_wall, i, a}; if (gap(p, c) < list.reach) list.contacts.push_back(c); }
            if (p.walls.upper[a] != WallKind::absent) { Contact c{ContactKind::upper_wall, i, a}; if (gap(p, c) < list.reach) list.contacts.push_back(c); }
        }
    }
    std::sort(list.contacts.begin(), list.contacts.end());
    return list;
}
template <int Dim> Admissibility certify_admissible(const Packing<Dim>& p, double allowance) {
    Admissibility a; a.verdict = Verdict::proved; a.worst_gap = std::numeric_limits<double>::infinity();
    for (const auto& c : find_candidates(p, 0.5).contacts) { const double h = gap(p, c); if (h < a.worst_gap) { a.worst_gap = h; a.worst = c; } }
    if (a.worst_gap < -allowance) a.verdict = Verdict::refuted;
    return a;
}
template struct CandidateList<2>;
template CandidateList<2> find_candidates<2>(const Packing<2>&, double);
template Admissibility certify_admissible<2>(const Packing<2>&, double);
}
