#include "certificate/state_certifier.hpp"

#include "contact/words.hpp"
#include "io/files.hpp"
#include "io/state_json.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <utility>

namespace isostat {

StateCertifier::StateCertifier(const std::filesystem::path& run, std::string program, RunCounters& counters,
                               RunObserver& next)
    : folder_(run / "certificates"), program_(std::move(program)), counters_(counters), next_(next) {
    make_directory(folder_);
}

void StateCertifier::on_equilibrium(const EquilibriumRecord& record, const State& state,
                                    const std::vector<double>& forces) {
    const auto begin = std::chrono::steady_clock::now();
    const ProvedStructure* const proved = std::exchange(proved_, nullptr);
    Certificate certificate;
    certificate.input = fmt::format("equilibrium {}", record.number);
    certificate.program = program_;
    certificate.state = state;
    certificate.state.provenance.clear();
    const std::string text = state_text(certificate.state);
    certificate.input_hash = sha256(text);
    const Certification result = certify(certificate.state, {}, proved);
    certificate.claims = result.claims;
    write_output(folder_ / fmt::format("eq_{:06}.json", record.number), json::certificate_text(certificate, text),
                 "\"isostat-certificate\"");
    StateTally& tally = counters_.states;
    (result.verdict == Verdict::proved    ? tally.proved
     : result.verdict == Verdict::refuted ? tally.refuted
                                          : tally.undecided)++;
    tally.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    EquilibriumRecord certified = record;
    certified.certified = result.verdict;
    if (result.verdict == Verdict::refuted) {
        certified.verdict = Verdict::refuted;
        objection_ = failed(FailureKind::contradiction, "equilibrium {} is refuted by its certificate: {}",
                            record.number, fmt::format("{}", fmt::join(result.refuted, "; ")));
    }
    next_.on_equilibrium(certified, state, forces);
}

} // namespace isostat
