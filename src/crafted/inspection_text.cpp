#include "contact/words.hpp"
#include "core/index.hpp"
#include "core/refuse.hpp"
#include "packing/bodies.hpp"
#include "packing/words.hpp"

#include <isostat/core/result.hpp>
#include <isostat/crafted/exact_packing.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <utility>

namespace isostat::crafted {

namespace {

constexpr std::size_t longest_list = 60;

/// "12-40, 3-left": the first names and the number of the others.
template <class Range, class Text> std::string joined(const Range& range, Text text) {
    std::string out;
    std::size_t count = 0;
    for (const auto& element : range) {
        if (++count <= longest_list) {
            out += (out.empty() ? "" : ", ") + text(element);
        }
    }
    return count > longest_list ? fmt::format("{}, and {} more", out, count - longest_list) : out;
}

/// The numbers below `count` for which `holds`, as numbers of disks.
template <class Holds> std::vector<int> numbers_where(std::size_t count, Holds holds) {
    std::vector<int> out;
    for (std::size_t k = 0; k < count; ++k) {
        if (holds(k)) {
            out.push_back(static_cast<int>(k));
        }
    }
    return out;
}

std::vector<int> disks_with(const Inspection& inspection, DiskHold hold) {
    return numbers_where(inspection.hold.size(), [&](std::size_t i) { return inspection.hold[i] == hold; });
}

std::string vector_text(const std::vector<Number>& vector, const std::vector<std::string>& names) {
    return joined(numbers_where(vector.size(), [&](std::size_t k) { return !vector[k].is_zero(); }),
                  [&](int k) { return fmt::format("{}: {}", names[at(k)], vector[at(k)].text()); });
}

std::string number_list(const std::vector<int>& numbers) {
    return numbers.empty() ? "none" : joined(numbers, [](int i) { return std::to_string(i); });
}

/// The table, with a function for each of its parts.
class InspectionTable {
  public:
    InspectionTable(const Inspection& inspection, const ExactPacking& packing)
        : inspection_(inspection), packing_(packing), exact_(inspection.rank_exact == Verdict::proved),
          contact_names_(contact_names(inspection.contacts, packing.dimension())) {
        counts();
        grains();
        forces();
        bases();
    }
    [[nodiscard]] std::string text() && { return std::move(out_); }

  private:
    void line(const std::string& key, const std::string& value) { out_ += fmt::format("{:<22} {}\n", key, value); }
    [[nodiscard]] std::string grain() const { return grain_word(packing_.dimension()); }

    void counts() {
        const char* most = exact_ ? "" : "<= ";
        line(grain() + "s", std::to_string(packing_.disk_count()));
        if (!packing_.bars.empty()) {
            line("bodies", fmt::format("{}, each of one {} or more", Bodies(approximate(packing_)).count(), grain()));
        }
        line("degrees of freedom N_f", std::to_string(inspection_.dof_count));
        line("contacts N", fmt::format("{} (gaps decided exactly)", inspection_.contact_count()));
        const std::span listed = std::span(contact_names_).first(static_cast<std::size_t>(inspection_.contact_count()));
        line("contact list", listed.empty() ? "none" : joined(listed, [](const std::string& name) { return name; }));
        line("rank", fmt::format("{}{} ({})", exact_ ? "" : ">= ", inspection_.rank,
                                 exact_ ? "proved" : "lower bound proved, upper bound undecided"));
        line("hyperstaticity h", fmt::format("{}{}", most, inspection_.hyperstaticity));
        line("mechanisms k", fmt::format("{}{} ({} common rigid motions, {}{} internal)", most, inspection_.mechanisms,
                                         inspection_.rigid_motions, most, inspection_.internal_mechanisms()));
        line("verdict", inspection_.verdict());
        line("generic rank", fmt::format("{} (same contact graph, random coordinates)", inspection_.generic_rank));
        line("rank with radii",
             fmt::format("{}{} (the radii move too)", inspection_.with_radii.rank_exact == Verdict::proved ? "" : ">= ",
                         inspection_.with_radii.rank));
        line("special position", std::string(to_string(inspection_.special_position)));
        for (std::size_t k = 0; inspection_.strains && k < strains.size(); ++k) {
            const Counting& c = (*inspection_.strains)[k];
            const char* bound = c.rank_exact == Verdict::proved ? "" : "<= ";
            line(to_string(strains[k]), fmt::format("N_f = {}, N = {}, h = {}{}, k = {}{}", c.dof_count,
                                                    c.contact_count, bound, c.hyperstaticity, bound, c.mechanisms));
        }
        if (inspection_.jamming) {
            const std::string of = fmt::format(" ({} {}s that are no rattlers)", inspection_.jamming->disks, grain());
            line("jammed collectively", std::string(to_string(inspection_.jamming->collective)) + of);
            if (inspection_.jamming->strict) {
                line("jammed strictly", std::string(to_string(*inspection_.jamming->strict)) + of);
            }
        }
    }

    void grains() {
        line("rattlers", number_list(disks_with(inspection_, DiskHold::rattler)));
        line("bridges", number_list(disks_with(inspection_, DiskHold::bridge)));
        if (inspection_.forces_unique &&
            (inspection_.support == Support::positive || inspection_.support == Support::with_zeros)) {
            line(grain() + "s without force", number_list(inspection_.without_force));
        }
    }

    void forces() {
        const auto contacts = [&](const std::vector<int>& numbers, const char* none) {
            return numbers.empty() ? none : joined(numbers, [&](int l) { return contact_names_[at(l)]; });
        };
        line("contacts without force",
             contacts(numbers_where(contact_names_.size(), [&](std::size_t l) { return inspection_.carrying[l] == 0; }),
                      "none by position of the normals"));
        line("self-stress, one sign",
             inspection_.one_sign_decided ? to_string(inspection_.one_sign.kind) : "undecided");
        line("support of the load",
             fmt::format("{}{}", to_string(inspection_.support), inspection_.forces_unique ? " (forces unique)" : ""));
        if (!inspection_.forces.empty()) {
            line(inspection_.forces_unique ? "forces" : "forces, one choice",
                 vector_text(inspection_.forces, contact_names_));
        }
        for (const LoadRange& range : inspection_.ranges) {
            line("supported", range_text(range));
        }
        for (const auto& [key, structural] : {std::pair("zero for any position", true), {"zero by position", false}}) {
            const std::vector<int> zeros = numbers_where(inspection_.structural_zero.size(), [&](std::size_t l) {
                return inspection_.forces[l].is_zero() && (inspection_.structural_zero[l] != 0) == structural;
            });
            if (!zeros.empty()) {
                line(key, contacts(zeros, ""));
            }
        }
        line("second order (bars)", to_string(inspection_.second_order));
        line("stable", packing_.load ? std::string(to_string(inspection_.stable)) : "no load");
    }

    /// "force on top wall from 2/5 (no force in 0-bottom) to 2 (no force in 1-left)".
    [[nodiscard]] std::string range_text(const LoadRange& range) const {
        const auto end = [&](const std::optional<Number>& force, const std::vector<int>& zero, const char* none) {
            if (!force) {
                return std::string(none);
            }
            const std::string in = joined(zero, [&](int l) { return contact_names_[at(l)]; });
            return zero.empty() ? force->text() : fmt::format("{} (no force in {})", force->text(), in);
        };
        return fmt::format(
            "force on {} from {} to {}", dof_names(approximate(packing_))[static_cast<std::size_t>(range.dof)],
            end(range.least, range.zero_at_least, "-infinity"), end(range.most, range.zero_at_most, "infinity"));
    }

    void bases() {
        constexpr std::size_t most = 10;
        if (inspection_.bases_exact != Verdict::proved) {
            return;
        }
        for (std::size_t s = 0; s < std::min(inspection_.self_stresses.size(), most); ++s) {
            line(fmt::format("self-stress {}", s + 1), vector_text(inspection_.self_stresses[s], contact_names_));
        }
        for (std::size_t m = 0; m < std::min(inspection_.motions.size(), most); ++m) {
            line(fmt::format("motion {}", m + 1),
                 vector_text(inspection_.motions[m], dof_names(approximate(packing_))));
        }
    }

    const Inspection& inspection_;
    const ExactPacking& packing_;
    bool exact_;
    std::vector<std::string> contact_names_;
    std::string out_;
};

/// Compares the values that a file expects with the values found.
class Comparison {
  public:
    Comparison(const Inspection& inspection, const ExactPacking& packing, const std::string& source)
        : inspection_(inspection), names_(contact_names(inspection.contacts, packing.dimension())),
          dofs_(dof_names(approximate(packing))), source_(source), words_(words(inspection)) {}

    void check(const ExpectedEntry& entry) {
        static const std::map<std::string, void (Comparison::*)(const ExpectedEntry&, const std::vector<std::string>&)>
            rows_of{{"forces", &Comparison::check_force},
                    {"ranges", &Comparison::check_range},
                    {"strains", &Comparison::check_strain}};
        if (const auto word = words_.find(entry.key); word != words_.end()) {
            check_word(entry, word->second);
        } else if (auto found = list(entry.key)) {
            check_list(entry, std::move(*found));
        } else if (const auto rows = rows_of.find(entry.key); rows != rows_of.end()) {
            for (const auto& row : entry.values) {
                (this->*rows->second)(entry, row);
            }
        } else {
            bad(entry,
                "a known key: N_f, N, rank, h, k, rigid_motions, generic_rank, special, verdict, contacts, "
                "forces, strains, rattlers, bridges, without_force, structural_zeros, "
                "jammed_collectively, jammed_strictly, one_sign, support, second_order, stable, rank_with_radii or "
                "ranges");
        }
    }
    [[nodiscard]] std::vector<std::string> mismatches() && { return std::move(out_); }

  private:
    static std::string jammed(const std::optional<Verdict>& verdict) {
        return verdict ? std::string(to_string(*verdict)) : "no cell whose axes all repeat";
    }
    static std::map<std::string, std::string> words(const Inspection& inspection) {
        // A count that is only a bound equals no expected value.
        const auto count = [&](int value) {
            return inspection.rank_exact == Verdict::proved ? std::to_string(value) : "undecided";
        };
        return {
            {"N_f", std::to_string(inspection.dof_count)},
            {"N", std::to_string(inspection.contact_count())},
            {"rank", count(inspection.rank)},
            {"h", count(inspection.hyperstaticity)},
            {"k", count(inspection.mechanisms)},
            {"rigid_motions", std::to_string(inspection.rigid_motions)},
            {"generic_rank", std::to_string(inspection.generic_rank)},
            {"rank_with_radii", inspection.with_radii.rank_exact == Verdict::proved
                                    ? std::to_string(inspection.with_radii.rank)
                                    : "undecided"},
            {"special", std::string(to_string(inspection.special_position))},
            {"verdict", inspection.verdict()},
            {"one_sign", inspection.one_sign_decided ? to_string(inspection.one_sign.kind) : "undecided"},
            {"support", to_string(inspection.support)},
            {"second_order", to_string(inspection.second_order)},
            {"stable", std::string(to_string(inspection.stable))},
            {"jammed_collectively",
             jammed(inspection.jamming ? std::optional(inspection.jamming->collective) : std::nullopt)},
            {"jammed_strictly", jammed(inspection.jamming ? inspection.jamming->strict : std::nullopt)},
        };
    }

    [[noreturn]] void bad(const ExpectedEntry& entry, const std::string& wanted) const {
        refuse(ErrorKind::bad_input, "{}:{}: expected.{}: expected {}", source_, entry.line, entry.key, wanted);
    }
    void mismatch(const ExpectedEntry& entry, const std::string& wanted, const std::string& found) {
        out_.push_back(fmt::format("{}:{}: {}: expected {}, found {}", source_, entry.line, entry.key, wanted, found));
    }

    void check_word(const ExpectedEntry& entry, const std::string& found) {
        if (entry.values.size() != 1 || entry.values[0].size() != 1) {
            bad(entry, "one value");
        }
        if (entry.values[0][0] != found) {
            mismatch(entry, entry.values[0][0], found);
        }
    }

    /// The list that a key names; empty when the key names no list.
    [[nodiscard]] std::optional<std::vector<std::string>> list(const std::string& key) const {
        std::vector<std::string> found;
        const auto numbers = [&](const std::vector<int>& disks) {
            std::ranges::transform(disks, std::back_inserter(found), [](int i) { return std::to_string(i); });
        };
        const auto contacts = [&](const auto& listed) {
            for (const int l : numbers_where(inspection_.contacts.size(), listed)) {
                found.push_back(names_[at(l)]);
            }
        };
        if (key == "contacts") {
            contacts([&](std::size_t l) { return inspection_.contacts[l].kind != ContactKind::bar; });
        } else if (key == "structural_zeros") {
            const auto& zero = inspection_.structural_zero;
            contacts([&](std::size_t l) { return l < zero.size() && zero[l] != 0; });
        } else if (key == "without_force") {
            numbers(inspection_.without_force);
            if (!inspection_.forces_unique) {
                found.emplace_back("forces that are not unique");
            }
        } else if (key == "rattlers" || key == "bridges") {
            numbers(disks_with(inspection_, key == "rattlers" ? DiskHold::rattler : DiskHold::bridge));
        } else {
            return {};
        }
        return found;
    }

    void check_list(const ExpectedEntry& entry, std::vector<std::string> found) {
        std::vector<std::string> wanted;
        for (const auto& row : entry.values) {
            wanted.insert(wanted.end(), row.begin(), row.end());
        }
        std::ranges::sort(wanted);
        std::ranges::sort(found);
        if (wanted != found) {
            mismatch(entry, fmt::format("[{}]", fmt::join(wanted, ", ")), fmt::format("[{}]", fmt::join(found, ", ")));
        }
    }

    [[nodiscard]] Number number(const ExpectedEntry& entry, const std::string& text) const {
        try {
            return Number::parse(text);
        } catch (const Error& error) {
            refuse(ErrorKind::bad_input, "{}:{}: expected.{}: {}", source_, entry.line, entry.key, error.what());
        }
    }

    void check_force(const ExpectedEntry& entry, const std::vector<std::string>& row) {
        if (row.size() != 2) {
            bad(entry, "pairs [contact, force]");
        }
        const Number wanted = number(entry, row[1]);
        std::string found = inspection_.forces_unique ? "no such contact" : "forces that are not unique";
        bool holds = false;
        for (std::size_t l = 0; l < inspection_.contacts.size() && inspection_.forces_unique; ++l) {
            if (names_[l] == row[0]) {
                found = inspection_.forces[l].text();
                holds = inspection_.forces[l] == wanted;
            }
        }
        if (!holds) {
            mismatch(entry, row[0] + " = " + wanted.text(), found);
        }
    }

    void check_range(const ExpectedEntry& entry, const std::vector<std::string>& row) {
        if (row.size() != 3) {
            bad(entry, "rows [wall, period or tilt, least force, largest force]");
        }
        std::string found = "no range";
        for (const LoadRange& range : inspection_.ranges) {
            if (dofs_[static_cast<std::size_t>(range.dof)] == row[0]) {
                found = fmt::format("{} to {}", range.least ? range.least->text() : "none",
                                    range.most ? range.most->text() : "none");
            }
        }
        const auto text = [&](const std::string& end) { return end == "none" ? end : number(entry, end).text(); };
        const std::string wanted = fmt::format("{} to {}", text(row[1]), text(row[2]));
        if (wanted != found) {
            mismatch(entry, fmt::format("{}: {}", row[0], wanted), found);
        }
    }

    void check_strain(const ExpectedEntry& entry, const std::vector<std::string>& row) {
        const auto* const known =
            std::ranges::find_if(strains, [&](Strain strain) { return !row.empty() && row[0] == to_string(strain); });
        if (row.size() != 5 || known == strains.end()) {
            bad(entry, "rows [\"fixed cell\", \"isotropic\", \"diagonal\" or \"full strain\", N_f, N, h, k]");
        }
        std::string found = "no cell whose axes all repeat";
        if (inspection_.strains) {
            const Counting& c = (*inspection_.strains)[static_cast<std::size_t>(known - strains.begin())];
            found = c.rank_exact == Verdict::proved
                        ? fmt::format("{}, {}, {}, {}", c.dof_count, c.contact_count, c.hyperstaticity, c.mechanisms)
                        : "undecided";
        }
        const std::string wanted = fmt::format("{}, {}, {}, {}", row[1], row[2], row[3], row[4]);
        if (wanted != found) {
            mismatch(entry, row[0] + " = " + wanted, found);
        }
    }

    const Inspection& inspection_;
    std::vector<std::string> names_, dofs_;
    const std::string& source_;
    std::map<std::string, std::string> words_;
    std::vector<std::string> out_;
};

} // namespace

const char* to_string(DiskHold hold) {
    static constexpr auto words = words_of<DiskHold>("held", "bridge", "rattler", "fixed", "loaded", "member");
    return word_of(hold, words);
}

const char* to_string(Support support) {
    static constexpr auto words =
        words_of<Support>("positive", "with zeros", "none", "unbalanced", "undecided", "no load");
    return word_of(support, words);
}

const char* to_string(SecondOrder answer) {
    static constexpr auto words = words_of<SecondOrder>("no mechanism", "rigid", "flexes", "undecided");
    return word_of(answer, words);
}

const char* to_string(exact::OneSign sign) {
    static constexpr auto words = words_of<exact::OneSign>("strict", "partial", "none");
    return word_of(sign, words);
}

std::string to_text(const Inspection& inspection, const ExactPacking& packing) {
    return InspectionTable(inspection, packing).text();
}

std::vector<std::string> check_expected(const Inspection& inspection, const PackingFile& file,
                                        const std::string& source) {
    Comparison comparison(inspection, file.packing, source);
    for (const ExpectedEntry& entry : file.expected) {
        comparison.check(entry);
    }
    return std::move(comparison).mismatches();
}

} // namespace isostat::crafted
