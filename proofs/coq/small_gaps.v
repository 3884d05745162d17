(** Statement T6 (../contact_candidates.md): a pair with a small gap is an edge of the regular triangulation.

    Disks (c, a) and (c', b) with gap g >= 0, g (2 (a + b) + g) < 2 m (a + b),
      m a lower bound of the radii (so g < 2 (sqrt 2 - 1) m will do: it is
    the case a = b = m). The point [between] has the same power p for both,
      and a greater one for every other disk that overlaps neither:
    the segment between the two lifted points is then an edge of the lower hull. *)
From mathcomp Require Import all_ssreflect all_algebra ring.
From Isostat Require Import power_cells.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.
Section SmallGaps.
Variable F : rcfType.
Variables (c c' : point F) (a b m : F).
Hypotheses (a0 : 0 < a) (b0 : 0 < b) (m0 : 0 < m).
Let d := Num.sqrt (dist2 c c').
Let g := d - (a + b).
Hypothesis g0 : 0 <= g.
Hypothesis small : g * (2%:R * (a + b) + g) < 2%:R * m * (a + b).
Let w := (d ^+ 2 + a ^+ 2 - b ^+ 2) / (2%:R * d ^+ 2).
Definition between : point F := (c.1 + w * (c'.1 - c.1), c.2 + w * (c'.2 - c.2)).

Let S0 : 0 < a + b. Proof. by rewrite addr_gt0. Qed.
Let dE : d = a + b + g. Proof. by rewrite /g addrC subrK. Qed.
Let d0 : 0 < d. Proof. by rewrite dE ltr_spaddl. Qed.
Let d2 : d ^+ 2 = dist2 c c'. Proof. by rewrite sqr_sqrtr ?dist2_ge0. Qed.
Let dn : d != 0. Proof. by rewrite gt_eqF. Qed.

Let weights : 2%:R * d ^+ 2 * w = (2%:R * a + g) * (a + b) + g * d /\ 2%:R * d ^+ 2 * (1 - w) = (2%:R * b + g) * (a +
  b) + g * d.
Proof.
have e : 2%:R * d ^+ 2 * w = d ^+ 2 + a ^+ 2 - b ^+ 2.
  by rewrite /w mulrC divfK // mulf_neq0 ?expf_neq0 // pnatr_eq0.
by split; rewrite ?mulrBr ?e ?mulr1 dE; ring.
Qed.

Let dd0 : 0 < 2%:R * d ^+ 2. Proof. by rewrite mulr_gt0 ?exprn_gt0 ?ltr0n. Qed.
Let w0 : 0 <= w.
Proof.
rewrite -(pmulr_rge0 _ dd0) (proj1 weights).
by rewrite addr_ge0 // mulr_ge0 ?(ltW d0) ?(ltW S0) // addr_ge0 // mulr_ge0 ?ler0n ?(ltW a0).
Qed.
Let w1 : 0 <= 1 - w.
Proof.
rewrite -(pmulr_rge0 _ dd0) (proj2 weights).
by rewrite addr_ge0 // mulr_ge0 ?(ltW d0) ?(ltW S0) // addr_ge0 // mulr_ge0 ?ler0n ?(ltW b0).
Qed.

(** Stewart's theorem, with the weights 1 - w and w. *)
Lemma stewart (x : point F) :
  dist2 between x = (1 - w) * dist2 x c + w * dist2 x c' - w * (1 - w) * d ^+ 2.
Proof. by rewrite d2 /between /dist2 /=; ring. Qed.

Let p := power c a between.
Let pE : p = w ^+ 2 * d ^+ 2 - a ^+ 2.
Proof. by rewrite /p /power /between d2 /dist2 /=; ring. Qed.

Lemma equal_powers : power c' b between = p.
Proof.
rewrite pE; have -> : power c' b between = (1 - w) ^+ 2 * d ^+ 2 - b ^+ 2 by rewrite /power /between d2 /dist2 /=; ring.
have e := proj1 weights.
have e2 : 2%:R * d ^+ 2 * w = d ^+ 2 + a ^+ 2 - b ^+ 2 by rewrite e dE; ring.
apply/eqP; rewrite -subr_eq0; apply/eqP.
have -> : (1 - w) ^+ 2 * d ^+ 2 - b ^+ 2 - (w ^+ 2 * d ^+ 2 - a ^+ 2) = d ^+ 2 + a ^+ 2 - b ^+ 2 - 2%:R * d ^+ 2 * w
  by ring.
by rewrite e2 subrr.
Qed.

Lemma power_is_small : p < m * ((1 - w) * a + w * b).
Proof.
have [e1 e2] := weights.
rewrite -subr_gt0 -(pmulr_rgt0 _ dd0) -(@pmulr_rgt0 _ 2%:R) ?ltr0n //.
have D : d != 0 := dn.
have -> : 2%:R * (2%:R * d ^+ 2 * (m * ((1 - w) * a + w * b) - p))
   = (2%:R * a + g) * (2%:R * b + g) * (2%:R * m * (a + b) - g * (2%:R * (a + b) + g)).
  have -> : 2%:R * (2%:R * d ^+ 2 * (m * ((1 - w) * a + w * b) - p))
      = 2%:R * m * ((2%:R * d ^+ 2 * (1 - w)) * a + (2%:R * d ^+ 2 * w) * b) - (2%:R * d * w) ^+ 2 * d ^+ 2 + 2%:R ^+
        2 * d ^+ 2 * a ^+ 2.
    by rewrite pE; ring.
  have -> : (2%:R * d * w) ^+ 2 * d ^+ 2 = (2%:R * d ^+ 2 * w) ^+ 2 by ring.
  by rewrite e1 e2 dE; ring.
by rewrite mulr_gt0 ?subr_gt0 // mulr_gt0 // ltr_paddr // mulr_gt0 ?ltr0n.
Qed.

Theorem pair_with_small_gap_is_an_edge (x : point F) (r : F) :
  m <= r -> apart x r c a -> apart x r c' b -> p < power x r between.
Proof.
move=> mr ai bj.
have -> : power x r between = (1 - w) * dist2 x c + w * dist2 x c' - w * (1 - w) * d ^+ 2 - r ^+ 2 by rewrite /power
  stewart.
have low : (1 - w) * (r + a) ^+ 2 + w * (r + b) ^+ 2 <= (1 - w) * dist2 x c + w * dist2 x c'.
  by apply: ler_add; apply: ler_wpmul2l.
apply: lt_le_trans (_ : p < (1 - w) * (r + a) ^+ 2 + w * (r + b) ^+ 2 - w * (1 - w) * d ^+ 2 - r ^+ 2) _; last first.
  by rewrite !ler_add2r.
have q : p = (1 - w) * p + w * (power c' b between) by rewrite equal_powers; ring.
have -> : (1 - w) * (r + a) ^+ 2 + w * (r + b) ^+ 2 - w * (1 - w) * d ^+ 2 - r ^+ 2
   = 2%:R * (r * ((1 - w) * a + w * b)) - ((1 - w) * p + w * (power c' b between)).
  have -> : power c' b between = (1 - w) ^+ 2 * d ^+ 2 - b ^+ 2 by rewrite /power /between d2 /dist2 /=; ring.
  by rewrite pE; ring.
rewrite -q ltr_subr_addr.
have -> : p + p = 2%:R * p by ring.
rewrite ltr_pmul2l ?ltr0n //.
apply: lt_le_trans power_is_small _; apply: ler_wpmul2r mr.
by rewrite addr_ge0 // mulr_ge0 // ltW.
Qed.
End SmallGaps.

(** The constant: g < 2 (sqrt 2 - 1) m is enough for all radii above m. *)
Theorem constant_of_small_gaps (F : rcfType) (a b m g : F) :
  0 < m -> m <= a -> m <= b -> 0 <= g -> g < 2%:R * (Num.sqrt 2%:R - 1) * m ->
    g * (2%:R * (a + b) + g) < 2%:R * m * (a + b).
Proof.
move=> m0 ma mb g0 gm.
set k : F := Num.sqrt 2%:R in gm; have k2 : k ^+ 2 = 2%:R by rewrite sqr_sqrtr ?ler0n.
have S2 : 2%:R * m <= a + b by rewrite mulr_natl mulr2n ler_add.
have gk : g + 2%:R * m < 2%:R * k * m.
  have -> : 2%:R * k * m = 2%:R * (k - 1) * m + 2%:R * m by ring.
  by rewrite ltr_add2r.
(* (g + 2m)^2 < 8 m^2 settles a + b = 2m; beyond, 2 g <= 2 m. *)
have sq : (g + 2%:R * m) ^+ 2 < (2%:R * k * m) ^+ 2.
  by rewrite ltr_pexpn2r ?nnegrE // ?addr_ge0 ?mulr_ge0 ?sqrtr_ge0 ?ler0n ?(ltW m0).
have base : g * (2%:R * (2%:R * m) + g) < 2%:R * m * (2%:R * m).
  rewrite -subr_gt0; rewrite -subr_gt0 in sq.
  have -> : 2%:R * m * (2%:R * m) - g * (2%:R * (2%:R * m) + g) = (2%:R * k * m) ^+ 2 - (g + 2%:R * m) ^+ 2 - 4%:R *
    (k ^+ 2 - 2%:R) * m ^+ 2 by ring.
  by rewrite k2 subrr mulr0 mul0r subr0.
have gle : g <= m.
  rewrite leNgt; apply/negP => mg; move: base; rewrite ltNge => /negP; apply.
  have -> : 2%:R * m * (2%:R * m) = m * (2%:R * (2%:R * m)) by ring.
  by apply: ler_pmul; rewrite ?mulr_ge0 ?ler0n ?(ltW m0) ?(ltW mg) // ler_addl.
rewrite -subr_gt0.
have -> : 2%:R * m * (a + b) - g * (2%:R * (a + b) + g)
   = (2%:R * m * (2%:R * m) - g * (2%:R * (2%:R * m) + g)) + 2%:R * ((m - g) * (a + b - 2%:R * m)) by ring.
by rewrite ltr_paddr ?subr_gt0 // mulr_ge0 ?ler0n // mulr_ge0 ?subr_ge0.
Qed.

Print Assumptions constant_of_small_gaps.
Print Assumptions pair_with_small_gap_is_an_edge.
