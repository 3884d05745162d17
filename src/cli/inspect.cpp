#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/true_vertex_text.hpp"

#include <isostat/io/state_file.hpp>
#include <isostat/rigidity/counting.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

namespace isostat::cli {

namespace {

std::string end_of_interval(double stress, const Contact& opens) {
    return std::isfinite(stress) ? fmt::format("{:.12g} (opens {})", stress, to_string<2>(opens)) : "unbounded";
}

void print_counting(const State<2>& state, const Counting& c) {
    fmt::print("disks                    {}\n", state.packing.disk_count());
    fmt::print("box                      {:.12g} x {:.12g}, solid fraction {:.6f}\n", state.packing.length(0),
               state.packing.length(1), state.packing.solid_fraction());
    fmt::print("load                     sigma = ({:.12g}, {:.12g}), {}\n", state.load.stress[0], state.load.stress[1],
               state.load.kind == LoadKind::nominal ? "nominal (constant wall forces)" : "true stresses");
    fmt::print("degrees of freedom N_f   {}\n", c.dof_count);
    fmt::print("contacts N               {}\n", c.contact_count);
    fmt::print("rank, stored coordinates {} ({})\n", c.rank,
               c.rank_exact == Verdict::proved ? "exact" : "proved lower bound");
    fmt::print("self-stresses h          {}\n", c.hyperstaticity);
    fmt::print("mechanisms k             {}\n", c.mechanisms);
}

void print_inspection(const Inspection<2>& inspection) {
    const EquilibriumRecord<2>& r = inspection.record;
    fmt::print("rattlers                 {}\n", inspection.rattlers.size());
    fmt::print("force-carrying contacts  {}\n", r.backbone);
    if (inspection.equilibrium) {
        fmt::print("supported interval       from {}\n", end_of_interval(r.stress_low, r.opens_low));
        fmt::print("                         to   {}\n", end_of_interval(r.stress_high, r.opens_high));
        fmt::print("smallest force           {:.6g} in {} (every force known to {:.2g})\n", r.min_force,
                   to_string<2>(r.min_force_contact), r.force_bound);
    }
    fmt::print("smallest gap             {:.6g} of {}\n", r.min_gap, to_string<2>(r.min_gap_contact));
    fmt::print("largest gap of a contact {:.2g}\n", r.gap_residual);
    fmt::print("smallest singular value  at least {:.3g}\n", r.sigma_min_bound);
    if (inspection.equilibrium) {
        fmt::print("balance of forces        {:.2g}, virtual power {:.2g}\n", r.balance, r.virtual_power);
        fmt::print("smallest margin          {:.3g} ({})\n", r.margin, to_string(r.decided_by));
    }
    fmt::print("isostatic equilibrium    {}{}{}\n", to_string(r.verdict), inspection.remark.empty() ? "" : ": ",
               inspection.remark);
    fmt::print("stable                   {}\n", to_string(inspection.stable));
}

Json counting_json(const std::string& file, const State<2>& state, const Counting& c) {
    Json object;
    object["file"] = file;
    object["disks"] = state.packing.disk_count();
    object["length"] = {number(state.packing.length(0)), number(state.packing.length(1))};
    object["solid_fraction"] = number(state.packing.solid_fraction());
    object["stress"] = {number(state.load.stress[0]), number(state.load.stress[1])};
    object["load"] = state.load.kind == LoadKind::nominal ? "nominal" : "true";
    object["N_f"] = c.dof_count;
    object["N"] = c.contact_count;
    object["rank"] = c.rank;
    object["rank_exact"] = to_string(c.rank_exact);
    object["h"] = c.hyperstaticity;
    object["k"] = c.mechanisms;
    return object;
}

void add_inspection(Json& object, const Inspection<2>& inspection) {
    const EquilibriumRecord<2>& r = inspection.record;
    object["rattlers"] = inspection.rattlers;
    object["backbone"] = r.backbone;
    object["held"] = r.held;
    if (inspection.equilibrium) {
        const auto name = [](double stress, const Contact& contact) {
            return std::isfinite(stress) ? Json(to_string<2>(contact)) : Json(nullptr);
        };
        object["supported_interval"] = {number(r.stress_low), number(r.stress_high)};
        object["opens"] = {name(r.stress_low, r.opens_low), name(r.stress_high, r.opens_high)};
        object["min_force"] = number(r.min_force);
        object["min_force_contact"] = to_string<2>(r.min_force_contact);
        object["force_bound"] = number(r.force_bound);
        object["balance"] = number(r.balance);
        object["virtual_power"] = number(r.virtual_power);
        object["margin"] = number(r.margin);
        object["decided_by"] = to_string(r.decided_by);
    }
    object["min_gap"] = number(r.min_gap);
    object["min_gap_contact"] = to_string<2>(r.min_gap_contact);
    object["gap_residual"] = number(r.gap_residual);
    object["sigma_min_bound"] = number(r.sigma_min_bound);
    object["verdict"] = to_string(r.verdict);
    object["stable"] = to_string(inspection.stable);
    object["remark"] = inspection.remark;
}

} // namespace

int inspect(const InspectArguments& arguments) {
    if (arguments.file.ends_with(".toml")) {
        return inspect_packing(arguments);
    }
    State<2> state = read_state<2>(arguments.file).state;
    const Certification truth = certify(state); // of the coordinates as they are stored
    snap_to_grid(state.packing);
    const Result<Inspection<2>> result = inspect_vertex(state);
    Counting counting = result.ok() ? result.value().counting : count_contacts(state.packing, state.contacts);
    if (const auto& stored = truth.claims.counting) {
        counting.rank = stored->rank;
        counting.hyperstaticity = stored->hyperstaticity;
        counting.mechanisms = stored->hypostaticity;
        counting.rank_exact = Verdict::proved;
    }
    const bool refuted = !result.ok() && result.failure().kind == FailureKind::not_isostatic;
    if (arguments.common.json) {
        Json object = counting_json(arguments.file, state, counting);
        if (result.ok()) {
            add_inspection(object, result.value());
        } else {
            object["verdict"] = refuted ? "refuted" : "undecided";
            object["remark"] = result.failure().message;
        }
        object["true_configuration"] = true_vertex_json(truth);
        print_json(object);
    } else {
        print_counting(state, counting);
        if (result.ok()) {
            print_inspection(result.value());
        } else {
            fmt::print("isostatic equilibrium    {}: {}\n", refuted ? "refuted" : "undecided",
                       result.failure().message);
        }
        print_true_vertex(truth);
    }
    return result.ok() ? status_of(result.value().record.verdict) : status_of(result.failure().kind);
}

} // namespace isostat::cli
