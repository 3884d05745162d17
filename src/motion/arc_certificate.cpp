#include "core/dot.hpp"
#include "motion/certify_arc.hpp"
#include "motion/gap_watch.hpp"
#include "motion/moving_part.hpp"
#include "motion/power_watch.hpp"

#include <isostat/core/machine.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace isostat {

namespace {

/// Bound of the distance between the true vertex and the stored configuration.
double uncertainty(const VertexEnclosure& vertex) {
    double square = 0;
    for (const double c : vertex.correction) {
        square += c * c;
    }
    return (vertex.radius + std::sqrt(square)) * upward;
}

class Certifier {
  public:
    Certifier(const ArcVertex& start, ContactId opened, int direction, const ArcVertex& end, const PowerLoad& power,
              CandidateList candidates, InverseBoundCache& cache, const ArcCertificateOptions& options)
        : start_(start), end_(end), slot_(opened.index()), direction_(direction), candidates_(std::move(candidates)),
          cache_(cache), options_(options), load_(power) {}

    /// First tries the bounds of the vertices; when the rows of the opened and of the closed contact are unsuitable
    /// (they change slowly compared with other coordinates), uses the fastest coordinates instead.
    ArcCertificate run() {
        if (!check_input()) {
            return std::move(certificate_);
        }
        ArcCertificate best = attempt(false);
        const bool judged = load_.load != nullptr && (load_.infinitesimal || load_.load->kind == LoadKind::nominal);
        if (!hopeless_ && (best.verdict != Verdict::proved || (judged && best.power != Verdict::proved))) {
            const int factorisations = best.factorisations;
            ArcCertificate other = attempt(true);
            if (best.verdict != Verdict::proved || other.power == Verdict::proved) {
                best = std::move(other);
            }
            best.factorisations = factorisations + certificate_.factorisations;
        }
        return best;
    }

  private:
    using Piece = CurvePiece;
    /// The current piece of the curve, its centre, and where on the piece the next stretch begins, up to `slack`.
    struct Front {
        std::unique_ptr<ArcCentre> centre;
        std::unique_ptr<Piece> piece;
        double from = 0;
        double slack = 0;
    };

    bool refuse(std::string reason) {
        certificate_.reason = std::move(reason);
        return false;
    }
    [[nodiscard]] const Contact& opened() const { return start_.structure.contacts()[slot_]; }
    [[nodiscard]] const Contact& closed() const { return end_.structure.contacts()[slot_]; }

    ArcCertificate attempt(bool fresh_ends);
    bool begin();
    bool place_ends();
    bool aim_at_end(double to);
    std::optional<Front> ahead_of(const std::vector<double>& frontier, double open, double to);
    bool follow();
    bool check_input();
    bool check_vertex(const ArcVertex& vertex, const Contact& zero, const char* name);
    std::unique_ptr<Piece> proved_piece(const ArcCentre& centre, double forward);
    bool finish(const Piece& piece, double from, double to);
    bool arrive(const Piece& last, double from, double joint_slack);
    [[nodiscard]] std::vector<double> moving_coordinates(const Packing& at) const;

    const ArcVertex& start_;
    const ArcVertex& end_;
    std::size_t slot_;
    int direction_;
    CandidateList candidates_;
    std::vector<Contact> active_;
    InverseBoundCache& cache_;
    ArcCertificateOptions options_;
    std::unique_ptr<MovingPart> part_;
    Front front_;
    std::unique_ptr<ArcCentre> end_centre_;
    std::unique_ptr<Piece> last_; ///< the piece at `end_centre_`
    GapWatch watch_;
    const PowerLoad& load_;
    PowerWatch* power_ = nullptr;
    bool fresh_ends_ = false;
    bool hopeless_ = false; ///< fresh ends would not help
    double end_rate_ = -1;  ///< rate of the free row at the end
    ArcCertificate certificate_;
    double start_uncertainty_ = 0;
    double end_uncertainty_ = 0;
};

bool Certifier::check_input() {
    const auto& a = start_.structure.contacts();
    const auto& b = end_.structure.contacts();
    if (start_.enclosure.verdict != Verdict::proved || end_.enclosure.verdict != Verdict::proved ||
        start_.inverse.verdict != Verdict::proved || end_.inverse.verdict != Verdict::proved) {
        return refuse("an end of the arc is not a proved vertex");
    }
    for (std::size_t l = 0; l < std::max(a.size(), b.size()); ++l) {
        if (l >= a.size() || l >= b.size() || (l != slot_ && a[l] != b[l])) {
            return refuse("the ends differ in more than one contact");
        }
        if (l != slot_ && a[l].kind == ContactKind::held) {
            const auto k = static_cast<std::size_t>(a[l].i);
            if (start_.packing.q[k] != end_.packing.q[k]) {
                return refuse(
                    fmt::format("{} is not at the same place at both ends", to_string(a[l], start_.packing.dimension)));
            }
        }
    }
    if (start_.packing.radius != end_.packing.radius) {
        return refuse("the ends differ in their radii");
    }
    return true;
}

/// Every candidate except the contacts has a positive gap at the true vertex; the gap of `zero` may be 0.
bool Certifier::check_vertex(const ArcVertex& vertex, const Contact& zero, const char* name) {
    for (const Contact& contact : active_) {
        if (contact != zero && !gap_at_vertex(vertex.packing, vertex.enclosure, contact).positive()) {
            return refuse(fmt::format("the gap of {} is not proved positive at the {}",
                                      to_string(contact, start_.packing.dimension), name));
        }
    }
    return true;
}

/// The piece at a centre with the longest proved tube; null: no tube is proved.
std::unique_ptr<CurvePiece> Certifier::proved_piece(const ArcCentre& centre, double forward) {
    auto piece = std::make_unique<Piece>(part_->curve(), centre, forward);
    const double floor = options_.smallest_step * start_.packing.min_radius();
    for (double h = piece->natural_reach(); h > floor; h *= 0.6) { // guess: length of a piece
        if (piece->prove(h)) {
            return piece;
        }
    }
    return nullptr;
}

/// Proves gaps and power for s in [from, to] of a proved piece.
bool Certifier::finish(const Piece& piece, double from, double to) {
    ++certificate_.pieces;
    certificate_.tube = std::max(certificate_.tube, piece.radius());
    certificate_.tube_margin = std::min(certificate_.tube_margin, piece.margin());
    if (!part_->complete(piece, std::max(std::abs(from), std::abs(to)), candidates_)) {
        candidates_ = find_candidates(piece.centre(), candidate_fraction, candidates_.triangulation);
        if (!part_->complete(piece, std::max(std::abs(from), std::abs(to)), candidates_)) {
            return refuse("the motion within one piece leaves the reach of the candidate list");
        }
        active_.clear();
    }
    if (active_.empty()) {
        active_ = part_->watched(candidates_);
    }
    watch_.begin(piece, from, to);
    for (const Contact& contact : active_) {
        if (!watch_.look(piece, contact, from, to)) {
            const double s = watch_.where();
            return refuse(fmt::format("the gap of {} is not proved positive in piece {} at s = {:.6g} of [{:.6g}, "
                                      "{:.6g}] (tube {:.3g})",
                                      to_string(contact, start_.packing.dimension), certificate_.pieces, s, from, to,
                                      piece.radius()));
        }
    }
    power_->look(piece, from, to);
    return true;
}

/// The end vertex lies on `last`: proves the remaining stretch and the gaps at the end.
bool Certifier::arrive(const Piece& last, double from, double joint_slack) {
    const auto place = last.locate(end_.packing.q, end_uncertainty_);
    if (!place) {
        return refuse("the end vertex is not proved to lie on the curve");
    }
    const double to = place->s + place->slack;
    if (!finish(last, from, std::max(to, from))) {
        return false;
    }
    // The end is ahead of the start of the piece; or this is the only piece and the closing gap, positive at the start
    // of the arc, falls all along it.
    const bool ahead = place->s - place->slack > from + 2 * joint_slack;
    if (!ahead && !(certificate_.pieces == 1 && closed() != opened() && watch_.fell_all_along(closed()))) {
        return refuse("the end is not proved to lie ahead of the start");
    }
    if (closed().kind != ContactKind::held && !watch_.falls(closed())) {
        return refuse(fmt::format("the gap of {} is not proved to fall to 0 at the end",
                                  to_string(closed(), start_.packing.dimension)));
    }
    certificate_.turning = opened().kind != ContactKind::held && GapWatch::rate_sign(last, opened(), place->s) < 0;
    return check_vertex(end_, closed(), "end");
}

std::vector<double> Certifier::moving_coordinates(const Packing& at) const {
    const DofMap& dofs = part_->curve().dofs;
    std::vector<double> q;
    for (int mu = 0; mu < dofs.dof_count(); ++mu) {
        q.push_back(at.q[static_cast<std::size_t>(dofs.coordinate_of(mu))]);
    }
    return q;
}

ArcCertificate Certifier::attempt(bool fresh_ends) {
    fresh_ends_ = fresh_ends;
    certificate_ = {};
    certificate_.tube_margin = std::numeric_limits<double>::infinity();
    watch_ = {};
    active_.clear();
    PowerWatch power(load_);
    power_ = &power;
    hopeless_ = !begin();
    if (!hopeless_ && place_ends() && follow()) {
        certificate_.verdict = Verdict::proved;
        certificate_.witness.whole = part_->whole();
        certificate_.witness.grains = part_->grains();
        certificate_.witness.end = moving_coordinates(end_.packing);
        power.conclude(certificate_, closed().kind == ContactKind::held);
    }
    certificate_.gap_margin = watch_.margin();
    return certificate_;
}

/// Finds the moving part and its equations, and proves the gaps at the start. False: fresh ends would not help either.
bool Certifier::begin() {
    start_uncertainty_ = uncertainty(start_.enclosure);
    end_uncertainty_ = uncertainty(end_.enclosure) + MovingPart::shift_of_end(start_, end_);
    part_ = std::make_unique<MovingPart>(start_, end_, slot_, start_uncertainty_, end_uncertainty_);
    certificate_.moving = static_cast<int>(part_->curve().contacts.size());
    if (!part_->trouble().empty()) {
        return refuse(part_->trouble());
    }
    if (!candidates_.covers(start_.packing)) {
        candidates_ = find_candidates(start_.packing, candidate_fraction, candidates_.triangulation);
    }
    // Pairs at rest keep the gap that they have at the start.
    active_ = part_->all(candidates_);
    if (!check_vertex(start_, opened(), "start")) {
        return false;
    }
    active_.clear();
    if (opened().kind != ContactKind::held) {
        watch_.starts_at_zero(opened());
    }
    return true;
}

/// Makes the centres at the two ends, and the piece at the start. A released coordinate determines the direction of the
/// curve, so its row is kept.
bool Certifier::place_ends() {
    double rate = opened().kind == ContactKind::held ? static_cast<double>(direction_) : 1.0;
    const auto with_fastest = [&](std::unique_ptr<ArcCentre>& vertex, double& forward) {
        ++certificate_.factorisations;
        vertex = vertex ? part_->with_fastest(*vertex, forward, cache_) : nullptr;
    };
    front_.centre = part_->at_start(cache_);
    end_centre_ = part_->at_end(cache_);
    end_rate_ = -1;
    if (fresh_ends_ && opened().kind != ContactKind::held) {
        with_fastest(front_.centre, rate);
    }
    if (fresh_ends_ && closed().kind != ContactKind::held) {
        with_fastest(end_centre_, end_rate_);
    }
    if (!front_.centre || !end_centre_) {
        return refuse("the grains that move are not proved isostatic at an end");
    }
    front_.piece = proved_piece(*front_.centre, rate);
    if (!front_.piece) {
        return refuse("no tube around the start");
    }
    const auto place = front_.piece->locate(start_.packing.q, start_uncertainty_);
    if (!place) {
        return refuse("the start vertex is not proved to lie on the curve");
    }
    front_.from = place->s - place->slack;
    front_.slack = place->slack;
    return true;
}

/// Makes `last_`, the piece at the end, run in the direction in which the present piece reaches it; false: no tube.
bool Certifier::aim_at_end(double to) {
    const bool held = closed().kind == ContactKind::held;
    if (last_ && !(held && last_->forward() != front_.piece->direction_along(*last_, to))) {
        return true;
    }
    if (held) {
        end_rate_ = last_                                                               ? -last_->forward()
                    : front_.piece->slope(to)[static_cast<std::size_t>(closed().i)] > 0 ? 1
                                                                                        : -1;
    }
    last_ = proved_piece(*end_centre_, end_rate_);
    return last_ != nullptr;
}

/// A fresh centre ahead of the end p(to) of the present piece, known up to `open`, whose tube overlaps that piece.
std::optional<Certifier::Front> Certifier::ahead_of(const std::vector<double>& frontier, double open, double to) {
    const Piece& piece = *front_.piece;
    const double floor = options_.smallest_step * start_.packing.min_radius();
    std::string why = "the curve was not followed";
    for (double ahead = 0.85 * to; ahead > floor; ahead *= 0.5) { // guess: next centre
        auto at = piece.corrected(to + ahead);
        if (!at) {
            continue;
        }
        const std::vector<double> velocity = piece.slope(to + ahead);
        const auto fastest = std::max_element(velocity.begin(), velocity.end(),
                                              [](double a, double b) { return std::abs(a) < std::abs(b); });
        ++certificate_.factorisations;
        Front next;
        next.centre = part_->centre(std::move(*at), static_cast<int>(fastest - velocity.begin()), cache_);
        if (!next.centre) {
            why = "no bound of the inverse on the way";
            continue;
        }
        next.piece = proved_piece(*next.centre, *fastest > 0 ? 1.0 : -1.0);
        if (!next.piece) {
            why = "no tube on the way";
            continue;
        }
        const auto place = next.piece->locate(frontier, open);
        if (place && piece.direction_along(*next.piece, to) == next.piece->forward()) {
            next.from = place->s - place->slack;
            next.slack = place->slack;
            return next;
        }
        why = "neighbouring pieces do not meet";
    }
    refuse(fmt::format("{} after {} pieces", why, certificate_.pieces));
    return std::nullopt;
}

/// Goes from piece to piece, until the end vertex lies on the present piece or on one that meets it.
bool Certifier::follow() {
    last_.reset();
    while (certificate_.pieces < options_.max_pieces) {
        const Piece& piece = *front_.piece;
        const auto target = piece.locate(end_.packing.q, end_uncertainty_);
        if (target && target->s > front_.from) {
            return arrive(piece, front_.from, front_.slack);
        }
        const double to = piece.reach() * (1 - 1e-6); // guess: place on the piece
        const std::vector<double> frontier = piece.point(to);
        const double open =
            // arcs.md A8 (a whole point)
            piece.radius() + std::sqrt(static_cast<double>(frontier.size())) * 0x1p-50 * largest(frontier);
        if (!aim_at_end(to)) {
            return refuse("no tube around the end");
        }
        const auto joint = last_->locate(frontier, open);
        if (joint && joint->s + joint->slack < 0 && piece.direction_along(*last_, to) == last_->forward()) {
            return finish(piece, front_.from, to) && arrive(*last_, joint->s - joint->slack, joint->slack);
        }
        auto next = ahead_of(frontier, open, to);
        if (!next || !finish(piece, front_.from, to)) {
            return false;
        }
        front_ = std::move(*next);
        certificate_.witness.centres.push_back({front_.centre->structure().contacts()[part_->curve().slot].i,
                                                moving_coordinates(front_.centre->packing())});
    }
    return refuse(fmt::format("more than {} pieces", options_.max_pieces));
}

} // namespace

ArcCertificate certify_arc(const ArcVertex& start, ContactId opened, int direction, const ArcVertex& end,
                           const PowerLoad& power, const CandidateList& candidates, InverseBoundCache& cache,
                           const ArcCertificateOptions& options) {
    require_floating_point();
    return Certifier(start, opened, direction, end, power, candidates, cache, options).run();
}

} // namespace isostat
