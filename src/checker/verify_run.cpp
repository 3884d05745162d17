#include "checker/choice.hpp"
#include "checker/first_order.hpp"
#include "checker/lookahead.hpp"
#include "checker/replay.hpp"
#include "checker/run_folder.hpp"
#include "checker/way.hpp"
#include "io/folders.hpp"
#include "io/record_digests.hpp"

#include <isostat/checker/verify.hpp>
#include <isostat/core/machine.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

using namespace checker;

/// Checks the records in order and stops at the first wrong one.
class Replay {
  public:
    Replay(const RunRecords& records, RunVerification& result)
        : records_(records), result_(result), witnesses_(records.directory / witness_records), lookahead_(records) {
        result.arcs = static_cast<int>(records.events.size());
        result.equilibria = static_cast<int>(records.equilibria.size());
        reached_.resize(records.equilibria.size() + 1);
    }

    void run(const std::function<void(const VerificationProgress&)>& progress) {
        progress_ = progress;
        const auto rows = static_cast<int>(records_.equilibria.size());
        for (int k = 0; k < rows || (k == rows && event_ < records_.events.size()); ++k) {
            if (k == rows) {
                open_row();
            }
            const EquilibriumLine& line = line_of(k);
            if (!expect(line.integer("number") == k, line.where,
                        fmt::format("the number is {}, expected {}", line.integer("number"), k))) {
                return;
            }
            const RunVerification before = result_;
            reach(line);
            if (stopped()) {
                again(k, before);
            }
            if (stopped()) {
                return;
            }
            report(k, std::min(k + 1, rows), true);
        }
        if (rows == 0 && records_.events.empty()) {
            leave("equilibria.csv", "no equilibrium was reached");
        }
        if (event_ < records_.events.size()) {
            const EventRecord& next = records_.events[event_];
            expect(false, next.where,
                   fmt::format("an arc towards equilibrium {}: expected {}", next.equilibrium, rows));
        }
    }

  private:
    [[nodiscard]] bool stopped() const { return !result_.wrong.empty(); }
    /// False: the record is wrong, and the replay stops.
    bool expect(bool holds, const std::string& where, const std::string& otherwise) {
        if (!holds && !stopped()) {
            result_.wrong = where + ": " + otherwise;
        }
        return holds;
    }
    void leave(const std::string& where, const std::string& why) { result_.undecided.push_back(where + ": " + why); }

    [[nodiscard]] bool is_row(int number) const { return number < result_.equilibria; }
    [[nodiscard]] const EquilibriumLine& line_of(int number) const {
        return is_row(number) ? records_.equilibria[static_cast<std::size_t>(number)] : open_row_;
    }
    /// Arcs after the last equilibrium lead to no equilibrium. They begin at the last equilibrium whose interval ends
    /// at their load, because a programme may go back to an earlier one.
    void open_row() {
        const auto arcs =
            std::count_if(records_.events.begin() + static_cast<std::ptrdiff_t>(event_), records_.events.end(),
                          [this](const EventRecord& event) { return event.equilibrium == result_.equilibria; });
        const EventRecord& first = records_.events[event_];
        const auto ends_there = [&first](const EquilibriumLine& line) {
            const auto is_at = [&](const char* end) {
                const std::string name = line.names->stress + end;
                const double room = line.bound(name) + record_tolerance * std::abs(first.stress);
                return std::abs(line.at(name) - first.stress) <= room;
            };
            return is_at("_low") || is_at("_high");
        };
        const auto from = std::find_if(records_.equilibria.rbegin(), records_.equilibria.rend(), ends_there);
        const int last = result_.equilibria - 1;
        open_row_.where = first.where;
        open_row_.value = {
            {"number", result_.equilibria},
            {"previous", from == records_.equilibria.rend() ? last : last - (from - records_.equilibria.rbegin())},
            {"arcs", static_cast<double>(arcs)}};
    }

    void report(int equilibrium, int equilibria, bool closed) {
        if (progress_) {
            progress_({equilibrium, closed, arcs_here_, arcs_before_ + arcs_here_, result_.arcs, equilibria,
                       result_.equilibria, static_cast<int>(result_.undecided.size())});
        }
        if (closed) {
            arcs_before_ += std::exchange(arcs_here_, 0);
        }
    }

    /// How ends of arcs are found: in steps; in small steps where these
    /// find an end; in either, and then proved to be on the curve.
    enum class Pace : unsigned char { fast, slow, certain };

    /// True: proved. False: left undecided and noted, or wrong and stopped.
    bool judged(const Objections& objection, const std::string& where) {
        if (!objection) {
            return true;
        }
        if (objection->wrong) {
            expect(false, where, objection->text);
        } else {
            leave(where, objection->text);
        }
        return false;
    }

    /// A check that stays undecided is repeated at the same vertices with more digits: a recorded number may lie closer
    /// to the end of its bound, or to 0, than the usual digits show. Not where radii are R_i + eps rho_i, because
    /// records there call a quantity 0 when it cannot be told from 0.
    template <class Check> Objections asked(const Check& check, Place* next = nullptr) {
        Objections open = check();
        for (const int digits : {more_digits, most_digits}) {
            if (!open || open->wrong || open->for_good || here_.first) {
                break;
            }
            (void)sharpen(here_, digits);
            if (next != nullptr) {
                (void)sharpen(*next, digits);
            }
            open = check();
        }
        return open;
    }

    /// Makes `here_` the vertex near a state; empty when no vertex is proved.
    void go_to(State state, const std::string& where, const ExactLoad& load) {
        Place place;
        place.chooses = records_.chooses;
        here_ = {};
        lookahead_.forget();
        if (judged(make_place(std::move(state), place, load), where)) {
            here_ = std::move(place);
        }
    }

    /// Makes `here_` the vertex at the exact load of a stored state.
    void go_to_stored(State state, const std::string& where) {
        const ExactLoad load = meant_load(state);
        go_to(std::move(state), where, load);
    }

    /// A contradiction to a row, or to an arc towards it, is checked again in small steps, because steps in double may
    /// have led to another vertex of the same contacts. It counts only where every arc from the last stored state on is
    /// proved to end where it was found to.
    void again(int number, const RunVerification& before) {
        const std::string seen = std::exchange(result_.wrong, {});
        std::vector<int> rows{number};
        for (int k = previous_of(number); k > 0 && k < rows.back() && !reached_[static_cast<std::size_t>(k)].stored;
             k = previous_of(k)) {
            rows.push_back(k);
        }
        if (!replayed({number}, Pace::slow, before)) {
            result_.wrong.clear();
            replayed(rows, Pace::certain, before);
        }
        if (!stopped() && result_.undecided.size() > before.undecided.size()) {
            leave(
                line_of(number).where,
                fmt::format(
                    "steps in double ended where the records seem wrong ({}), but not provably at the ends of the arcs",
                    seen));
        }
    }

    /// Checks rows again, the last one first in the list, from the last
    /// kept state before them. True: nothing is wrong or undecided.
    bool replayed(const std::vector<int>& rows, Pace pace, const RunVerification& before) {
        pace_ = pace;
        here_number_ = -1;
        for (auto row = rows.rbegin(); row != rows.rend() && !stopped(); ++row) {
            result_ = before;
            event_ = reached_[static_cast<std::size_t>(*row)].first_event;
            arcs_here_ = 0;
            reach(line_of(*row));
        }
        pace_ = Pace::fast;
        return !stopped() && result_.undecided.size() == before.undecided.size();
    }

    [[nodiscard]] int previous_of(int number) const { return line_of(number).integer("previous"); }

    /// The events of one rearrangement, which must be numbered in order.
    std::vector<const EventRecord*> events_of(const EquilibriumLine& line) {
        std::vector<const EventRecord*> events;
        reached_[static_cast<std::size_t>(line.integer("number"))].first_event = event_;
        while (event_ < records_.events.size() && records_.events[event_].equilibrium == line.integer("number")) {
            const EventRecord& event = records_.events[event_++];
            events.push_back(&event);
            expect(event.step == static_cast<long>(event_), event.where,
                   fmt::format("the step is {}, expected {}", event.step, event_));
            expect(event.arc == static_cast<int>(events.size()), event.where,
                   fmt::format("the arc is {}, expected {}", event.arc, events.size()));
            expect(static_cast<double>(event.choices) <= records_.max_choices, event.where,
                   fmt::format("choice {} of the run, which may choose {} ties", event.choices, records_.max_choices));
        }
        expect(line.integer("arcs") == static_cast<int>(events.size()), line.where,
               fmt::format("arcs is {}, but there are {} events", line.integer("arcs"), events.size()));
        return events;
    }

    void reach(const EquilibriumLine& line) {
        const std::vector<const EventRecord*> events = events_of(line);
        const int number = line.integer("number");
        if (!stopped()) {
            number == 0 ? begin(line, events) : depart(line);
        }
        for (const EventRecord* event : events) {
            if (here_.state && !stopped() && !arc(*event)) {
                here_ = {};
            }
            ++arcs_here_;
            report(number, number, false);
        }
        if (!is_row(number) || stopped()) {
            return;
        }
        if (here_.state && number > 0 && events.empty()) {
            reload(line);
        }
        if (!here_.state) {
            resume(line);
        }
        if (!stopped()) {
            close(line);
        }
    }

    /// Equilibrium 0 is the stored start, or arcs lead to it from start.json. The list holds those touching pairs with
    /// which these arcs end at the list of the equilibrium.
    void begin(const EquilibriumLine& line, const std::vector<const EventRecord*>& arcs) {
        expect(line.integer("previous") == -1, line.where,
               fmt::format("previous is {}, expected -1: there is none before", line.integer("previous")));
        std::optional<StateFile> file = records_.stored(0);
        if (!expect(file.has_value() || !is_row(0), line.where,
                    "states/eq_000000.json, the start of the replay, is missing")) {
            return;
        }
        if (arcs.empty()) {
            if (file) {
                go_to_stored(std::move(file->state), line.where);
            }
            return;
        }
        if (!records_.start) {
            leave(line.where, "the arcs from the start are not checked: there is no start.json");
            return;
        }
        State start = *records_.start;
        if (file) {
            auto list = list_before(std::move(file->state.contacts), arcs, start.packing);
            if (!expect(list.has_value(), line.where, "its arcs do not lead to the contacts of equilibrium 0")) {
                return;
            }
            start.contacts = std::move(*list);
            start.perturbation = start.perturbation ? start.perturbation : file->state.perturbation;
        }
        const bool ties = std::any_of(arcs.begin(), arcs.end(), [](const EventRecord* e) { return !e->ties.empty(); });
        if (ties && !start.perturbation) { // the run ended before it stored a state
            leave(line.where,
                  "the arcs from the start are not checked: no stored state has the direction of the radii");
            return;
        }
        go_to_stored(std::move(start), line.where);
        if (here_.state) {
            for (TieRecord tie : arcs.front()->ties) {
                if (tie.what == "start") {
                    tie.what = "opening";
                    here_.said.push_back(std::move(tie));
                }
            }
            judged(asked([&] { return check_start(here_, *records_.start); }), line.where);
        }
    }

    void depart(const EquilibriumLine& line) {
        const int previous = line.integer("previous");
        if (!expect(previous >= 0 && previous < line.integer("number"), line.where,
                    fmt::format("previous is {}, expected an equilibrium before", previous))) {
            return;
        }
        before_ = &line_of(previous);
        if (here_number_ != previous || !here_.state) {
            here_ = {};
            const Reached& from = reached_[static_cast<std::size_t>(previous)];
            if (from.state) {
                go_to(*from.state, line.where, from.load);
            } else {
                leave(line.where, "the equilibrium before was not reached by the replay");
            }
        }
    }

    [[nodiscard]] std::size_t index_of(const EventRecord& event) const {
        return static_cast<std::size_t>(&event - records_.events.data());
    }

    /// In a cell a run puts the pinned disk on its grid too, which becomes coarser as coordinates grow; here it stays.
    bool pin_may_have_moved() {
        const Packing& packing = here_.state->packing;
        coarsest_ = std::max(coarsest_, grid_step(packing));
        const auto off = [&](std::size_t a) {
            return packing.cell.periodic[a] &&
                   std::fmod(packing.coordinate(DiskId(packing.cell.pin), static_cast<int>(a)), coarsest_) != 0;
        };
        return off(0) || off(1) || (packing.dimension > plane && off(2));
    }

    /// The contacts that open and close at `here_` according to a record.
    struct Change {
        std::size_t position; ///< position of the opening contact in the list
        Contact closed;
        bool rattles = false;   ///< the infinitesimal loads open it, and only rattlers move
        int direction = +1;     ///< -1: a held coordinate that falls
        ExactLoad load{};       ///< load at which it opens
        bool from_zero = false; ///< the power of the load grows from 0

        [[nodiscard]] Opening opening() const { return {position, direction, rattles}; }
    };

    /// One arc from `here_`, which becomes its end. False: undecided, or wrong.
    bool arc(const EventRecord& event) {
        const bool pin_moved = pin_may_have_moved();
        if (!records_.certified_arcs) { // arcs with a witness are proved from it
            lookahead_.look_ahead(here_, index_of(event));
        }
        std::optional<Change> change = change_of(event);
        if (!change) {
            return false;
        }
        if (event.power_turn && !event.held_at) {
            return judged(Objection{false, "the record does not say where the coordinate is held"}, event.where);
        }
        if (event.power_turn && pin_moved) {
            return judged(Objection{false, "where the coordinate is held is said from the pinned disk, which a coarser "
                                           "grid may have moved by a rounding"},
                          event.where);
        }
        const bool opening = judged(asked([&] { return check_opening(event, *change); }), event.where);
        if (stopped()) {
            return false;
        }
        find_direction(event, *change);
        Place base;
        if (!exchange_lists(base, event, *change)) {
            return false;
        }
        if (here_.first && !judged(check_step(here_, event, change->position, change->direction), event.where)) {
            return false;
        }
        Place next;
        next.chooses = records_.chooses;
        const bool stays =
            std::any_of(event.ties.begin(), event.ties.end(), [](const TieRecord& tie) { return tie.what == "step"; });
        const bool proved = !stays && records_.certified_arcs && prove_way_to(next, event, *change);
        const Objections open = proved                   ? Objections()
                                : stays                  ? stay(next, event, *change)
                                : pace_ == Pace::certain ? arrive_certainly(next, event, *change)
                                : pace_ == Pace::slow    ? arrive_slowly(next, event, *change)
                                                         : arrive_somehow(next, event, *change);
        if (!check_arrival(base.state ? base : here_, next, event, *change, open)) {
            return false;
        }
        const auto chosen =
            std::count_if(event.ties.begin(), event.ties.end(), [](const TieRecord& t) { return !t.choice.empty(); });
        result_.ties_checked += static_cast<int>(event.ties.size());
        result_.choices_checked += static_cast<int>(chosen);
        next.said = event.ties;
        result_.turns_checked += event.power_turn ? 1 : 0;
        here_ = std::move(next);
        result_.arcs_proved += opening ? 1 : 0;
        result_.ways_proved += proved || stays ? 1 : 0;
        return true;
    }

    /// Nothing: the record has impossible names, and the replay stops.
    std::optional<Change> change_of(const EventRecord& event) {
        const std::optional<Contact> opened = contact_named(event.opened, here_.state->packing);
        const std::optional<Contact> closed = contact_named(event.closed, here_.state->packing);
        const auto list = list_that_opens(*here_.state, event);
        if (!expect(list.has_value(), event.where, "an exchange of contacts in the list that cannot be")) {
            return {};
        }
        const std::vector<Contact>& contacts = *list;
        const auto at = opened ? std::find(contacts.begin(), contacts.end(), *opened) : contacts.end();
        const bool closed_before =
            closed && closed != opened && std::find(contacts.begin(), contacts.end(), *closed) != contacts.end();
        if (!expect(at != contacts.end(), event.where, event.opened + " opens, but is no contact of the structure") ||
            !expect(closed.has_value(), event.where, event.closed + " closes, but is no pair of grains") ||
            !expect(!closed_before, event.where, event.closed + " closes, but is closed already") ||
            !expect(event.power_turn == (closed->kind == ContactKind::held), event.where,
                    fmt::format("power_turn is {}, but {} is what ends the arc", event.power_turn, event.closed)) ||
            !expect((event.arc == 1 && event.equilibrium > 0) == (event.kind == "limit"), event.where,
                    fmt::format("the kind is '{}' of arc {}: the first one from an equilibrium, and no other, starts "
                                "at a limit",
                                event.kind, event.arc))) {
            return {};
        }
        return Change{static_cast<std::size_t>(at - contacts.begin()), *closed, false, +1, here_.load};
    }

    /// Replaces the list that was reached by the one that opens; `base` keeps the former, if they differ.
    bool exchange_lists(Place& base, const EventRecord& event, const Change& change) {
        for (const TieRecord& tie : event.ties) {
            if (!exchanges_list(tie)) {
                continue;
            }
            if (!expect(here_.first != nullptr, event.where,
                        "an exchange of contacts in the list without a direction of radii") ||
                !judged(check_exchange(here_, tie, change.position), event.where)) {
                return false;
            }
            State state = *here_.state;
            std::replace(state.contacts.begin(), state.contacts.end(), *contact_named(tie.against, state.packing),
                         *contact_named(tie.contact, state.packing));
            state.load.set_loaded_stress(event.stress);
            Place next;
            next.chooses = records_.chooses;
            if (!judged(make_place(std::move(state), next, change.load), event.where)) {
                return false;
            }
            Place before = std::exchange(here_, std::move(next));
            if (!base.state) {
                base = std::move(before);
            }
        }
        return true;
    }

    /// Checks that the limit, or the rule, opens the recorded contact. At a limit `change` gets its exact load.
    Objections check_opening(const EventRecord& event, Change& change) {
        if (event.kind != "limit") {
            return check_rule(here_, event, change.position, records_);
        }
        const double here = here_.stress();
        const bool up = event.stress > here || (event.stress == here && before_->stress("_high") == here);
        const double bound = before_->bound(before_->names->stress + (up ? "_high" : "_low"));
        return check_limit(here_, event, bound, change.position, change.load);
    }

    /// The infinitesimal loads release a coordinate of a rattler, as they open its contacts.
    void find_direction(const EventRecord& event, Change& change) const {
        const Evidence& evidence = *here_.evidence;
        const bool held = here_.state->contacts[change.position].kind == ContactKind::held;
        change.rattles = event.kind == "rattler" || (held && evidence.forces[change.position].has_zero());
        const Range& multiplier = (change.rattles ? evidence.infinitesimal() : evidence.forces)[change.position];
        change.direction = held && multiplier.positive() ? -1 : +1;
        const bool bears = change.rattles && grains_bear_force(here_, change.position);
        change.rattles = change.rattles && !bears;
        change.from_zero = event.kind == "limit" || bears;
    }

    /// Position of the coordinate that a power turn holds, among the contacts at the end, or -1.
    static int fresh(const EventRecord& event, const Change& change) {
        return event.power_turn ? static_cast<int>(change.position) : -1;
    }

    /// The end from the witness of the arc. False: not proved, which is noted where the run claims a proof.
    bool prove_way_to(Place& next, const EventRecord& event, const Change& change) {
        const std::optional<Witness> witness = witnesses_.of(event.step);
        Objections missing = Objection{false, "the way is not proved: there is no witness"};
        if (witness) {
            const Way way{change.position, change.direction, change.rattles, change.from_zero, event.stress, *witness};
            State state = *here_.state;
            missing = end_of(here_, change.closed, way, state);
            missing = missing ? missing : make_place(state, next, change.load, fresh(event, change));
            missing = missing ? missing : prove_way(here_, next, way);
        }
        if (missing) {
            if (event.claims_way) {
                leave(event.where, missing->text);
            }
            next = Place();
        }
        return !missing;
    }

    /// The end of an arc that only changes the list.
    Objections stay(Place& next, const EventRecord& event, const Change& change) {
        State state = *here_.state;
        state.contacts[change.position] = change.closed;
        state.load.set_loaded_stress(event.stress);
        return make_place(std::move(state), next, change.load, fresh(event, change));
    }

    /// The end found by steps in double.
    Objections arrive(Place& next, const EventRecord& event, const Change& change, bool slowly) {
        Arrival arrival = slowly ? lookahead_.arrive_slowly(here_, index_of(event), change.opening(), change.load)
                                 : lookahead_.arrive(here_, index_of(event), change.opening(), change.load);
        if (!arrival.followed.wrong.empty()) {
            return Objection{false, arrival.followed.wrong + ", as far as steps in double tell"};
        }
        if (!arrival.followed.end) {
            return Objection{false, fmt::format("the motion that opens {} was not found to {} {}", event.opened,
                                                event.power_turn ? "turn with" : "close", event.closed)};
        }
        next = std::move(arrival.place);
        return std::move(arrival.open);
    }

    /// Arrives at the end of an arc, in small steps when the usual steps find no end.
    Objections arrive_somehow(Place& next, const EventRecord& event, const Change& change) {
        Objections open = arrive(next, event, change, false);
        return next.state ? open : arrive(next, event, change, true);
    }

    /// Arrives in small steps, if these find an end.
    Objections arrive_slowly(Place& next, const EventRecord& event, const Change& change) {
        Objections open = arrive(next, event, change, true);
        return next.state ? open : arrive(next, event, change, false);
    }

    /// Arrives at a vertex that is proved to be the end of the arc if this end agrees with the record.
    Objections arrive_certainly(Place& next, const EventRecord& event, const Change& change) {
        const Witness none{};
        const Way way{change.position, change.direction, change.rattles, change.from_zero, event.stress, none};
        Objections missing;
        for (const bool slowly : {false, true}) {
            Objections open = arrive(next, event, change, slowly);
            const bool found = next.evidence && next.evidence->vertex.found;
            missing = found ? prove_end(here_, next, way) : open;
            if (found && !missing) {
                return open;
            }
            next = Place();
        }
        return missing ? missing : Objection{false, "the end was not found"};
    }

    /// Checks that the end agrees with the record. `open`: objections to the
    /// vertex; `base`: start of the arc, with the list that was reached.
    bool check_arrival(const Place& base, Place& next, const EventRecord& event, const Change& change,
                       Objections open) {
        if (open && !open->wrong && next.evidence && next.evidence->vertex.found && !next.first) {
            open = sharpen(next, most_digits);
        }
        return judged(open, event.where) &&
               judged(asked([&] { return check_end(here_, next, event, change.rattles); }, &next), event.where) &&
               (!event.power_turn || judged(check_turn(next, event, change.rattles), event.where)) &&
               (!next.first ||
                judged(check_ties(base, here_, next, event, change.position, change.direction), event.where)) &&
               expect(next.first != nullptr || event.ties.empty(), event.where,
                      "first-order decisions in a run without a direction of the radii");
    }

    /// A row without arcs: the same vertex under another load.
    void reload(const EquilibriumLine& line) {
        State state = *here_.state;
        state.load.set_loaded_stress(line.stress());
        go_to(std::move(state), line.where, {});
    }

    /// Continues at a stored state after the replay was lost.
    void resume(const EquilibriumLine& line) {
        std::optional<StateFile> file = records_.stored(line.integer("number"));
        if (file) {
            go_to_stored(std::move(file->state), line.where);
        } else {
            leave(line.where, "not reached by the replay, and no state is stored");
        }
    }

    /// Checks the row, and the stored state if there is one.
    void close(const EquilibriumLine& line) {
        const int number = line.integer("number");
        Reached& reached = reached_[static_cast<std::size_t>(number)];
        reached.state.reset();
        if (!here_.state) {
            return;
        }
        if (here_.first && here_.ties.empty() && (here_.load.shift.lower != 0 || here_.load.shift.upper != 0)) {
            const std::vector<TieRecord> said = here_.said;
            go_to(State(*here_.state), line.where, {}); // no force vanishes, so the load is the stored one
            if (!here_.state) {
                return;
            }
            here_.said = said;
        }
        if (here_.fresh >= 0 && !here_.state->packing.bars.empty()) { // a free motion that stays held, by counting
            go_to(State(*here_.state), line.where, here_.load);
            if (!here_.state) {
                return;
            }
        }
        const std::string state = fmt::format("states/eq_{:06}.json", number);
        const bool row = judged(asked([&] { return check_equilibrium(here_, line); }), line.where);
        const bool row_and_files =
            row && same_file(state, line) && (number + 1 < result_.equilibria || same_file("states/last.json", line)) &&
            (records_.certified_states
                 ? judged(check_certificate(records_, here_, line), line.where)
                 : expect(line.integer("certified") == -1, line.where,
                          fmt::format("certified is {} at a level without certificates: expected -1",
                                      line.integer("certified"))));
        result_.equilibria_proved += row_and_files ? 1 : 0;
        reached.state = *here_.state;
        reached.load = here_.load;
        reached.stored = row_and_files && std::filesystem::exists(records_.directory / state);
        here_number_ = number;
    }

    /// Checks that a state file, if there is one, holds the equilibrium that was reached, and its forces.
    bool same_file(const std::string& name, const EquilibriumLine& line) {
        const std::filesystem::path path = records_.directory / name;
        if (!std::filesystem::exists(path)) {
            return true;
        }
        const StateFile file = read_any_state(path, Dimensions::any_clumps);
        return expect(file.state.equilibrium == line.integer("number"), name,
                      fmt::format("equilibrium is {}, expected {}", file.state.equilibrium, line.integer("number"))) &&
               judged(check_stored(here_, file.state, records_.start), name) &&
               judged(check_stored_forces(here_, file.forces), name);
    }

    const RunRecords& records_;
    RunVerification& result_;
    Witnesses witnesses_;
    std::function<void(const VerificationProgress&)> progress_;
    int arcs_before_ = 0; ///< arcs of finished equilibria
    int arcs_here_ = 0;
    Lookahead lookahead_;
    Place here_; ///< empty: the replay is lost
    int here_number_ = -1;
    EquilibriumLine open_row_;                ///< row for arcs after the last equilibrium
    const EquilibriumLine* before_ = nullptr; ///< start of the rearrangement
    std::size_t event_ = 0;
    struct Reached {
        std::optional<State> state; ///< nothing: the replay was lost
        ExactLoad load;
        bool stored = false;         ///< from the state file
        std::size_t first_event = 0; ///< of the rearrangement towards it
    };
    std::vector<Reached> reached_; ///< by number
    double coarsest_ = 0;          ///< largest grid step of the configurations so far
    Pace pace_ = Pace::fast;
};

} // namespace

RunVerification verify_run(const std::filesystem::path& directory,
                           const std::function<void(const VerificationProgress&)>& progress) {
    require_floating_point();
    RunVerification result;
    (void)content_of(directory, run_folder); // no link leads out of the folder, no pipe is read
    if (is_running(directory)) {
        result.finished = false;
        return result;
    }
    const RunRecords records = read_records(directory);
    result.notes = files_apart(records);
    if (const Objections damage = check_folder(directory, records)) {
        result.wrong = damage->text;
    } else {
        Replay(records, result).run(progress);
    }
    if (is_running(directory)) { // the run was resumed while it was read
        result = {};
        result.finished = false;
        return result;
    }
    if (!result.wrong.empty()) {
        result.verdict = Verdict::refuted;
    } else if (result.undecided.empty()) {
        result.verdict = Verdict::proved;
    }
    return result;
}

std::string words(const RunVerification& run) {
    if (!run.finished) {
        return "not finished";
    }
    if (run.verdict == Verdict::proved && run.ways_proved < run.arcs) {
        return "ends proved, way looked at";
    }
    return std::string(to_string(run.verdict));
}

} // namespace isostat
