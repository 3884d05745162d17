#include "checker/way.hpp"

#include "checker/courses.hpp"
#include "checker/index.hpp"

#include <fmt/format.h>

#include <set>

namespace isostat::checker {

namespace {

constexpr int most_pieces = 5000; // cost: pieces of a way
/// Share of a piece next to a limit or a power turn on which the power may stay open.
constexpr double open_share = 1e-2; // checker.md K20 (a hundredth)

Objections open(std::string why) {
    return Objection{false, "the way is not proved: " + std::move(why)};
}

/// Whether a coordinate of the packing belongs to one of the grains.
std::vector<bool> moving_coordinates(const State& state, const Problem& problem, const Witness& witness) {
    std::vector<bool> moves(state.packing.q.size(), false);
    const std::set<int> grains =
        witness.grains ? std::set<int>(witness.grains->begin(), witness.grains->end()) : std::set<int>();
    const std::size_t cell = state.packing.length_at(0);
    const std::size_t axes = state.packing.axes();
    for (std::size_t k = 0; k < moves.size(); ++k) { // behind the disks there is a grain for each coordinate
        const int grain =
            k < cell ? static_cast<int>(k / axes) : state.packing.disk_count() + static_cast<int>(k - cell);
        moves[k] = problem.dof_of[k] >= 0 && (!witness.grains || grains.contains(grain));
    }
    return moves;
}

class Follower {
  public:
    Follower(const Place& from, const Place& to, const Way& way) : from_(from), to_(to), way_(way) {}
    Objections prove();

  private:
    [[nodiscard]] const Contact& opened() const { return from_.state->contacts[way_.opened]; }
    [[nodiscard]] const Contact& closed() const { return to_.state->contacts[way_.opened]; }
    void let_rest();
    Objections set_up();
    void load();
    [[nodiscard]] std::vector<double> widened(const std::vector<double>& q) const;
    std::unique_ptr<Tube> start();
    [[nodiscard]] std::unique_ptr<Tube> tube_at(std::vector<double> centre, int row, int direction) const;
    Objections begin();
    /// Joins the tube around q, in which a row falls or grows as here, at s on this tube.
    bool join_near(const std::vector<double>& q, double s, int row);
    /// Joins such a tube at another configuration before `reach`.
    bool join_on_the_way(double reach);
    Objections chain();
    Objections arrive(const Bounds& place);
    bool join(std::unique_ptr<Tube> next, double s);
    bool finish(double to, bool last);

    const Place& from_;
    const Place& to_;
    const Way& way_;
    Moving moving_;
    Pushing pushing_;
    double start_off_ = 0; ///< 2-norm of the true start vertex minus the stored one, on moving coordinates
    double end_off_ = 0;
    std::unique_ptr<GapCourses> gaps_;
    std::unique_ptr<Tube> tube_;
    Bounds here_; ///< where on the tube the curve was entered
    int pieces_ = 0;
    std::string trouble_;
};

/// Marks what does not move.
void Follower::let_rest() {
    Packing& packing = moving_.state.packing;
    packing.fixed.assign(packing.radius.size(), 1);
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        packing.fixed[i] = moving_.disk_moves(static_cast<int>(i)) ? 0 : 1;
    }
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        const bool moves = moving_.moves[packing.length_at(a)];
        if (packing.walls.upper[a] == WallKind::movable && !moves) {
            packing.walls.upper[a] = WallKind::fixed;
        }
        packing.cell.period_moves[a] = packing.cell.period_moves[a] && moves;
    }
    for (std::size_t t = 0; t < packing.tilts() && packing.cell.any(); ++t) {
        packing.cell.tilt_moves[t] = moving_.moves[packing.length_at(packing.axes() + t)];
    }
}

Objections Follower::set_up() {
    const State& start = *from_.state;
    const Problem& problem = from_.evidence->problem;
    Load load = start.load;
    load.set_loaded_stress(way_.stress);
    for (const WallForce& wall : load.wall_forces(start.packing)) {
        if (!way_.rattles && load.kind == LoadKind::true_stress && (wall.rest[0] != 0 || wall.rest[1] != 0)) {
            return open("true stresses that change together are no doubles"); // their power has one factor more
        }
    }
    const std::vector<bool> moves = moving_coordinates(start, problem, way_.witness);
    moving_.state = start;
    moving_.moves = moves;
    if (way_.witness.grains && moving_.disk_moves(start.packing.cell.pin) && start.packing.cell.any()) {
        return open("the pinned disk is among the few that are said to move");
    }
    if (!start.packing.cell.any() || way_.witness.grains) { // in a cell all coordinates that can move do
        let_rest();
    }
    for (std::size_t k = 0; k < moves.size(); ++k) {
        moving_.loose.push_back(!moves[k] && problem.dof_of[k] >= 0);
        if (moves[k]) {
            moving_.coordinates.push_back(static_cast<int>(k));
        }
    }
    const auto takes_part = [this](const Contact& c) { return moving_.takes_part(c); };
    for (std::size_t l = 0; l < start.contacts.size(); ++l) {
        if (l != way_.opened && takes_part(start.contacts[l])) {
            moving_.kept.push_back(start.contacts[l]);
        }
    }
    if (moving_.kept.size() + 1 != moving_.coordinates.size() || !takes_part(opened()) || !takes_part(closed())) {
        return open("the grains that are said to move do not hang together by their contacts");
    }
    // K18: grains at rest have the same true place at both ends, the only root of their own equations there.
    const bool all = std::find(moving_.loose.begin(), moving_.loose.end(), true) == moving_.loose.end();
    const Rational& a = from_.evidence->vertex.moved_most;
    const Rational& b = to_.evidence->vertex.moved_most;
    const auto& within = from_.evidence->inverse.regular_within;
    if (!all && within && std::max<Rational>(a, b) >= *within) {
        return open("grains at rest are not proved to be at the same place at both ends");
    }
    moving_.rest = all ? 0 : rounded_up(a);
    const double coordinates = root_above(static_cast<double>(moving_.coordinates.size()));
    start_off_ = product_above(rounded_up(a), coordinates);
    end_off_ = product_above(rounded_up(b), coordinates);
    for (const Gap& gap : smallest_gaps(problem, start, from_.evidence->vertex)) {
        if (!way_.end_only && !gap.value.positive()) {
            return open(fmt::format("the gap of {} is not proved positive at the start",
                                    to_string(gap.pair, start.packing.dimension)));
        }
    }
    return {};
}

/// The recorded load: bounds of the exact products.
void Follower::load() {
    Load load = from_.state->load;
    load.set_loaded_stress(way_.stress);
    const std::vector<double>& on_disks = way_.rattles ? load.infinitesimal : load.disk_force;
    pushing_.fixed.assign(moving_.moves.size(), Bounds(0));
    std::copy(on_disks.begin(), on_disks.end(), pushing_.fixed.begin());
    if (way_.rattles) {
        return;
    }
    for (const WallForce& wall : load.wall_forces(from_.state->packing)) {
        if (load.kind == LoadKind::nominal) {
            const Bounds pressed = (Bounds(wall.stress) + wall.rest[0] + wall.rest[1]) * wall.length;
            Bounds& force = pushing_.fixed[at(wall.coordinate)];
            force = force - (from_.state->packing.dimension == plane ? pressed : pressed * wall.other);
        } else {
            pushing_.pressure[at(wall.axis)] = wall.stress;
        }
    }
}

std::unique_ptr<Tube> Follower::tube_at(std::vector<double> centre, int row, int direction) const {
    auto tube = Tube::make(moving_, std::move(centre), row, direction);
    return tube && tube->prove() ? std::move(tube) : nullptr;
}

/// Finds the fastest coordinate at the start and its direction, with any suitable row.
std::unique_ptr<Tube> Follower::start() {
    State state = moving_.state;
    state.contacts = moving_.kept;
    state.contacts.push_back(opened());
    const Problem problem(state, true);
    if (!problem.unsupported.empty() || problem.contacts() != problem.dofs()) {
        return nullptr;
    }
    const Solver solver(problem);
    if (!solver.usable()) {
        return nullptr;
    }
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(problem.contacts(), 1);
    b(problem.contacts() - 1, 0) = way_.direction;
    const Eigen::MatrixXd v = solver.solve(b);
    Eigen::Index fastest = -1;
    for (Eigen::Index k = 0; k < v.rows(); ++k) {
        const int coordinate = problem.coordinate_of[static_cast<std::size_t>(k)];
        const bool held = std::any_of(moving_.kept.begin(), moving_.kept.end(), [&](const Contact& c) {
            return c.kind == ContactKind::held && c.i == coordinate;
        });
        if (!held && (fastest < 0 || std::abs(v(k, 0)) > std::abs(v(fastest, 0)))) {
            fastest = k;
        }
    }
    return fastest < 0 ? nullptr
                       : tube_at(from_.state->packing.q, problem.coordinate_of[static_cast<std::size_t>(fastest)],
                                 v(fastest, 0) > 0 ? 1 : -1);
}

/// Proves gaps and power from `here_` to s.
bool Follower::finish(double s, bool last) {
    ++pieces_;
    if (!gaps_->look(*tube_, here_.lower, s)) {
        trouble_ = gaps_->trouble();
        return false;
    }
    const double length = s - here_.lower;
    const double begin = here_.lower + (pieces_ == 1 && way_.at_limit ? open_share * length : 0);
    const double end = s - (last && closed().kind == ContactKind::held ? open_share * length : 0);
    const bool power_ends = closed().kind == ContactKind::held;
    const auto proved = [&](double from) { return power_is_positive(pushing_, moving_, *tube_, from, end); };
    // Where the force that opens is negative but small, this force alone proves the power at the start.
    const bool starts = pieces_ == 1 && !way_.at_limit;
    if ((power_ends || !way_.end_only) && !proved(begin) && !(starts && proved(begin + open_share * length))) {
        trouble_ = "the power of the load is not proved positive";
        return false;
    }
    return true;
}

/// Continues the curve along the next tube, at s on the present one.
bool Follower::join(std::unique_ptr<Tube> next, double s) {
    if (!next) {
        return false;
    }
    double error = 0;
    const std::vector<double> q = tube_->point(s, error);
    const std::optional<Bounds> place = next->locate(q, sum_above(error, tube_->radius()));
    const Bounds slope = tube_->slope(next->row(), s) * static_cast<double>(next->direction());
    if (!place || !slope.positive() || !finish(s, false)) {
        return false;
    }
    tube_ = std::move(next);
    here_ = *place;
    return true;
}

std::vector<double> Follower::widened(const std::vector<double>& q) const {
    std::vector<double> all = moving_.state.packing.q;
    for (std::size_t k = 0; k < q.size(); ++k) {
        all[at(moving_.coordinates[k])] = q[k];
    }
    return all;
}

Objections Follower::arrive(const Bounds& place) {
    if (!finish(place.upper, true)) {
        return open(trouble_);
    }
    if (closed().kind != ContactKind::held && !gaps_->falls(closed())) {
        return open(fmt::format("the gap of {} is not proved to fall to 0 at the end",
                                to_string(closed(), moving_.state.packing.dimension)));
    }
    return {};
}

Objections Follower::begin() {
    tube_ = start();
    if (!tube_) {
        return open("no tube around the start");
    }
    const auto begin = tube_->locate(from_.state->packing.q, start_off_);
    if (!begin) {
        return open("the start is not proved to lie on the curve");
    }
    here_ = *begin;
    if (opened().kind == ContactKind::held) { // a released coordinate must move in the direction of its multiplier
        const Bounds slope = tube_->slope(opened().i, here_) * static_cast<double>(way_.direction);
        if (opened().i != tube_->row() ? !slope.positive() : tube_->direction() != way_.direction) {
            return open("the coordinate that is released is not proved to move");
        }
    }
    std::optional<std::vector<Contact>> watched;
    if (way_.end_only) {
        watched.emplace();
        if (closed().kind != ContactKind::held) {
            watched->push_back(closed());
        }
    }
    gaps_ = std::make_unique<GapCourses>(moving_, from_.state->contacts, opened(), std::move(watched));
    return {};
}

bool Follower::join_near(const std::vector<double>& q, double s, int row) {
    return join(tube_at(q, row, tube_->slope(row, s).middle() > 0 ? 1 : -1), s);
}

bool Follower::join_on_the_way(double reach) {
    bool found = false;
    // 0.9: cost: way to a centre; 1e-3: cost: shortest way to a centre; 0.5: cost: next shorter way to a centre
    for (double share = 0.9; share > 1e-3 && !found && trouble_.empty(); share *= 0.5) {
        const double on = here_.upper + share * (reach - here_.upper);
        found = on > here_.upper && join_near(tube_->corrected(on), on, tube_->fastest(on));
    }
    return found;
}

Objections Follower::chain() {
    if (Objections objection = begin()) {
        return objection;
    }
    const std::vector<Witness::Centre>& hints = way_.witness.centres;
    std::size_t hint = 0;
    for (int piece = 0; piece < most_pieces; ++piece) {
        const auto end = tube_->locate(to_.state->packing.q, end_off_);
        if (end && end->lower > here_.upper) {
            return arrive(*end);
        }
        const double reach = tube_->reach() * (1 - 1e-9); // cost: within the reach
        // The next configuration of the witness; after all of these the end, with the row that is fastest here.
        const bool last = hint >= hints.size();
        const std::vector<double> q = last ? to_.state->packing.q : widened(hints[hint].q);
        const auto row = at(tube_->row());
        const double ahead = (q[row] - tube_->centre()[row]) * tube_->direction();
        if (!last && ahead <= here_.upper) {
            ++hint;
            continue;
        }
        const double s = std::min(ahead, reach);
        bool joined = s > here_.upper && join_near(q, s, last ? tube_->fastest(s) : hints[hint].held);
        if (joined) {
            ++hint;
        } else if (trouble_.empty()) { // another configuration before that one
            joined = join_on_the_way(reach);
        }
        if (!trouble_.empty()) {
            return open(fmt::format("{} in piece {}", trouble_, pieces_));
        }
        if (!joined) {
            return open(fmt::format("no tube goes on after {} pieces", pieces_));
        }
    }
    return open(fmt::format("more than {} pieces", most_pieces));
}

Objections Follower::prove() {
    if (Objections objection = set_up()) {
        return objection;
    }
    load();
    return chain();
}

} // namespace

Objections end_of(const Place& from, const Contact& closed, const Way& way, State& end) {
    const std::vector<bool> moves = moving_coordinates(*from.state, from.evidence->problem, way.witness);
    end = *from.state;
    end.contacts[way.opened] = closed;
    end.load.set_loaded_stress(way.stress);
    std::size_t next = 0;
    const auto count = static_cast<std::size_t>(std::count(moves.begin(), moves.end(), true));
    for (const Witness::Centre& centre : way.witness.centres) {
        const bool row = centre.held >= 0 && at(centre.held) < moves.size() && moves[at(centre.held)];
        if (!row || centre.q.size() != count) {
            return open("the witness does not name the coordinates that move");
        }
    }
    if (way.witness.end.size() != count) {
        return open("the witness does not name the coordinates that move");
    }
    for (std::size_t k = 0; k < moves.size(); ++k) {
        if (moves[k]) {
            end.packing.q[k] = way.witness.end[next++];
        }
    }
    for (std::size_t l = 0; l < end.contacts.size(); ++l) {
        const Contact& c = end.contacts[l];
        if (l != way.opened && c.kind == ContactKind::held &&
            end.packing.q[at(c.i)] != from.state->packing.q[at(c.i)]) {
            return open(fmt::format("{} is at another place at the end", to_string(c, end.packing.dimension)));
        }
    }
    return {};
}

Objections prove_way(const Place& from, const Place& to, const Way& way) {
    return Follower(from, to, way).prove();
}

Objections prove_end(const Place& from, const Place& to, Way way) {
    way.end_only = true;
    return Follower(from, to, way).prove();
}

} // namespace isostat::checker
