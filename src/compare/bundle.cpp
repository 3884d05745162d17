#include "compare/path.hpp"
#include "core/parallel.hpp"

#include <isostat/snap/snap.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>

namespace isostat::compare {

namespace {

/// Arcs per rearrangement of a member: some rules take ten times as many as others, and a member records its end.
constexpr long most_arcs = 2000;

/// Where rattlers rest: at the lower or the upper side of an axis. In the plane these are the last four.
struct Rest {
    const char* name;
    std::size_t axis;
    bool lower;
};
constexpr std::array<Rest, 6> all_rests{{{"back", 2, true},
                                         {"front", 2, false},
                                         {"down", 1, true},
                                         {"up", 1, false},
                                         {"left", 0, true},
                                         {"right", 0, false}}};
std::span<const Rest> rests_in(int dimension) {
    return std::span(all_rests).last(2 * static_cast<std::size_t>(dimension));
}

/// `least_negative` is left out because it mostly ends in a tie, after arcs that take thousands of digits.
constexpr std::array rules{OpeningRule::most_negative, OpeningRule::least_index};

/// The loads of `generic_infinitesimal`, which point to the lower side of the last axis, turned to the side at which
/// the rattlers are to rest.
std::vector<double> infinitesimal_towards(const Rest& rest, const Packing& packing) {
    const std::size_t d = packing.axes(), last = d - 1;
    std::vector<double> g = generic_infinitesimal(packing.radius, 1, packing.dimension);
    for (std::size_t i = 0; i < g.size(); i += d) {
        if (rest.axis != last) {
            const double along = g[i + rest.axis];
            g[i + rest.axis] = g[i + last];
            g[i + last] = -along;
        }
        for (std::size_t a = 0; a < d && !rest.lower; ++a) {
            g[i + a] = -g[i + a];
        }
    }
    balance(g, packing.cell);
    return g;
}

BundleMember member(int number, std::span<const Rest> rests) {
    BundleMember out;
    const auto round = static_cast<std::size_t>(number) / rests.size();
    out.rule = round < rules.size() ? rules[round] : OpeningRule::random;
    out.seed = round < rules.size() ? 0 : round - rules.size() + 1;
    out.rest = rests[static_cast<std::size_t>(number) % rests.size()].name;
    return out;
}

/// Adds the equilibria of one member to the tree.
class Tree {
  public:
    explicit Tree(Bundle& out) : out_(out) {}

    void add(BundleMember member, Path path) {
        const int number = static_cast<int>(out_.members.size());
        std::vector<int> places; // node of each equilibrium
        for (PathEquilibrium& e : path.equilibria) {
            const auto [at, added] = node_.emplace(e.contacts, static_cast<int>(out_.nodes.size()));
            places.push_back(at->second);
            if (added) {
                out_.nodes.push_back({std::move(e), {}, {}});
                out_.nodes.back().equilibrium.number = at->second;
            }
            std::vector<int>& visited = out_.nodes[static_cast<std::size_t>(at->second)].members;
            if (visited.empty() || visited.back() != number) {
                visited.push_back(number);
            }
        }
        for (const int at : path.at_load) {
            member.at_load.push_back(at < 0 ? -1 : places[static_cast<std::size_t>(at)]);
        }
        member.nodes = std::move(places);
        member.end = std::move(path.end);
        out_.members.push_back(std::move(member));
    }

  private:
    Bundle& out_;
    std::map<std::vector<Contact>, int> node_;
};

int common_nodes(const std::vector<BundleMember>& members) {
    std::size_t longest = 0;
    for (const BundleMember& m : members) {
        longest = std::max(longest, m.nodes.size());
    }
    const auto same = [&](std::size_t k) {
        return std::ranges::all_of(members, [&](const BundleMember& m) {
            return k >= m.nodes.size() || m.nodes[k] == members.front().nodes[k];
        });
    };
    std::size_t k = 0;
    while (k < std::min(longest, members.front().nodes.size()) && same(k)) {
        ++k;
    }
    return static_cast<int>(k);
}

} // namespace

Bundle make_bundle(const State& start, const Path& path, const std::vector<double>& loads, int count,
                   const RunOptions& options) {
    Bundle out;
    if (count < 1 || path.equilibria.empty()) {
        return out;
    }
    std::vector<Path> paths(static_cast<std::size_t>(count));
    paths.front() = path;
    const Snap vertex =
        snap({start.packing, carrying(start, certify(start)), start.load}); // rattlers may leave their contacts
    const std::span<const Rest> rests = rests_in(start.packing.dimension);
    std::vector<std::optional<Result<State>>> at_rest(rests.size()); // for all rules
    parallel_pieces(std::min(rests.size(), paths.size()), [&](std::size_t rest) {
        if (rest == 0 && paths.size() <= rests.size()) {
            return; // the exact run is the only member
        }
        at_rest[rest] = vertex.outcome == SnapOutcome::vertex
                            ? with_resting_rattlers(vertex, infinitesimal_towards(rests[rest], vertex.packing))
                            : Failure{FailureKind::undecided, vertex.reason};
    });
    parallel_pieces(paths.size(), [&](std::size_t k) {
        if (k == 0) {
            return;
        }
        const BundleMember m = member(static_cast<int>(k), rests);
        const Result<State>& resting = *at_rest[k % rests.size()];
        if (!resting.ok()) {
            paths[k].end = resting.failure().message(start.packing.dimension);
            paths[k].at_load.assign(loads.size(), -1);
            return;
        }
        RunOptions run = options;
        run.rule = m.rule;
        run.rule_seed = m.seed;
        run.max_arcs = std::min(run.max_arcs, most_arcs);
        paths[k] = follow(resting.value(), loads, run);
    });
    Tree tree(out);
    for (std::size_t k = 0; k < paths.size(); ++k) {
        BundleMember m = member(static_cast<int>(k), rests);
        if (k == 0) {
            m.rule = options.rule;
            m.rest = "start";
        }
        tree.add(std::move(m), std::move(paths[k]));
    }
    out.common = common_nodes(out.members);
    return out;
}

int node_with(const Bundle& bundle, const std::vector<Contact>& list) {
    const auto at =
        std::ranges::find_if(bundle.nodes, [&](const BundleNode& node) { return node.equilibrium.contacts == list; });
    return at == bundle.nodes.end() ? -1 : at->equilibrium.number;
}

} // namespace isostat::compare
