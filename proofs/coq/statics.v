(** Statement T2 (../statics.md): forces of an isostatic structure, their dependence on the load,
  the opening direction. *)
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Isostatic.
Variables (F : fieldType) (n : nat) (G : 'M[F]_n).
Hypothesis regular : G \in unitmx.

(** h = 0 and k = 0 for a square matrix is regularity. *)
Lemma regular_iff_no_self_stress_no_mechanism (A : 'M[F]_n) :
  (A \in unitmx) = (\rank (kermx A) == 0%N) && (\rank (kermx A^T) == 0%N).
Proof.
rewrite !mxrank_ker mxrank_tr andbb subn_eq0 -row_full_unit /row_full eqn_leq.
by rewrite rank_leq_row.
Qed.

Definition forces (load : 'rV[F]_n) : 'rV_n := load *m invmx G.

Theorem forces_exist_and_are_unique (load f : 'rV[F]_n) : (f *m G == load) = (f == forces load).
Proof.
apply/eqP/eqP=> [<-|->]; first by rewrite /forces mulmxK.
by rewrite /forces mulmxKV.
Qed.

(** Paper, section 2.3: f = alpha sigma_1 + beta (sigma_2 - sigma_1). *)
Theorem forces_are_affine_in_the_load (F1 F2 : 'rV[F]_n) (s1 s2 : F) (l : 'I_n) :
  forces (s1 *: F1 + s2 *: F2) 0 l
    = forces (F1 + F2) 0 l * s1 + forces F2 0 l * (s2 - s1).
Proof.
have -> : s1 *: F1 + s2 *: F2 = s1 *: (F1 + F2) + (s2 - s1) *: F2.
  by rewrite scalerDr scalerBl -addrA [s1 *: F2 + _]addrCA subrr addr0.
rewrite /forces mulmxDl -!scalemxAl.
by rewrite mxE [X in X + _ = _]mxE [X in _ + X = _]mxE [s1 * _]mulrC [(s2 - s1) * _]mulrC.
Qed.

(** The motion with prescribed approach velocities is unique;
  with dV_l = 0 for l <> l0 it is the multiple [c] of one vector. *)
Definition opening (l0 : 'I_n) : 'cV[F]_n := - (invmx G *m delta_mx l0 0).

Theorem opening_direction_is_unique (l0 : 'I_n) (v : 'cV[F]_n) :
  (forall l, l != l0 -> (G *m v) l 0 = 0) -> v = - (G *m v) l0 0 *: opening l0.
Proof.
move=> rest; have Ev : G *m v = (G *m v) l0 0 *: delta_mx l0 0.
  apply/colP=> l; rewrite [RHS]mxE [delta_mx _ _ _ _]mxE eqxx andbT.
  by case: eqP => [->|/eqP/rest->]; rewrite ?mulr1 ?mulr0.
by rewrite -[LHS](mulKmx regular) {1}Ev -scalemxAr /opening scaleNr scalerN opprK.
Qed.

Theorem opening_has_unit_rate (l0 l : 'I_n) : (G *m opening l0) l 0 = - (l == l0)%:R.
Proof. by rewrite /opening mulmxN mulKVmx // !mxE eqxx andbT. Qed.

(** Power of the load in the motion v; in the opening of l0 it is minus the force in l0. *)
Theorem power_identity (load : 'rV[F]_n) (v : 'cV[F]_n) : load *m v = forces load *m (G *m v).
Proof. by rewrite mulmxA /forces mulmxKV. Qed.

Theorem power_of_opening (load : 'rV[F]_n) (l0 : 'I_n) : (load *m opening l0) 0 0 = - forces load 0 l0.
Proof.
rewrite power_identity mxE (bigD1 l0) //= opening_has_unit_rate eqxx mulrN1 big1 ?addr0 //.
by move=> l /negPf nl; rewrite opening_has_unit_rate nl oppr0 mulr0.
Qed.

(** What every coordinate-free choice of the code relies on: the force in l is the displacement response of the load
  (reciprocity). *)
Theorem reciprocity (l mu : 'I_n) : forces (delta_mx 0 mu) 0 l = - opening l mu 0.
Proof.
by rewrite /forces /opening -rowE -colE !mxE opprK.
Qed.
End Isostatic.

Section Interval.
Variable F : realFieldType.

(** An affine function that is positive at both ends of an interval is positive on it. *)
Lemma affine_positive_between (a b s t x : F) :
  0 < a + b * s -> 0 < a + b * t -> s <= x <= t -> 0 < a + b * x.
Proof.
move=> ps pt /andP[sx xt].
case: (lerP 0 b) => [b0|/ltW b0].
  by apply: lt_le_trans ps _; rewrite ler_add2l ler_wpmul2l.
by apply: lt_le_trans pt _; rewrite ler_add2l ler_wnmul2l.
Qed.

Lemma nonnegative_up_to_the_ratio (a b t : F) : b < 0 -> (0 <= a + b * t) = (t <= a / - b).
Proof. by move=> b0; rewrite ler_pdivl_mulr ?oppr_gt0 // -[RHS]subr_ge0 mulrN opprK mulrC. Qed.

(** The supported loads are an intersection of half-lines; in the direction of increasing s a limit [s0 - a l0 / b l0]
  (distance from the
    present load) that is not above the ratio of any other decreasing force bounds it exactly. *)
Theorem supported_interval_ends_at_the_smallest_ratio (n : nat) (a b : 'I_n -> F) (l0 : 'I_n) (t : F) :
  (forall l, 0 <= a l) -> b l0 < 0 ->
  (forall l, b l < 0 -> a l0 / - b l0 <= a l / - b l) ->
  0 <= t -> (forall l, 0 <= a l + b l * t) <-> t <= a l0 / - b l0.
Proof.
move=> a0 b0 least t0; split=> [/(_ l0)|tle l]; first by rewrite nonnegative_up_to_the_ratio.
case: (lerP 0 (b l)) => [bl|bl]; first by rewrite addr_ge0 ?a0 ?mulr_ge0.
by rewrite nonnegative_up_to_the_ratio // (le_trans tle) ?least.
Qed.

(** Signorini (paper, section 2.3): at a limit load only l0 carries no force;
  a motion that closes nothing and in which the load
    does not resist opens l0 only. *)
Theorem only_the_unloaded_contact_opens (n : nat) (f : 'rV[F]_n) (dV : 'cV[F]_n) (l0 : 'I_n) :
  (forall l, l != l0 -> 0 < f 0 l) -> f 0 l0 = 0 ->
  (forall l, dV l 0 <= 0) -> 0 <= (f *m dV) 0 0 -> forall l, l != l0 -> dV l 0 = 0.
Proof.
move=> pos zero sep pow l nl.
have term i : f 0 i * dV i 0 <= 0.
  case: (eqVneq i l0) => [->|ni]; first by rewrite zero mul0r.
  by rewrite pmulr_rle0 ?pos.
have sum0 : \sum_i - (f 0 i * dV i 0) = 0.
  apply/eqP; rewrite eq_le; apply/andP; split.
    by rewrite sumrN oppr_le0; move: pow; rewrite mxE.
  by apply: sumr_ge0 => i _; rewrite oppr_ge0.
have /eqP := sum0; rewrite psumr_eq0; last by move=> i _; rewrite oppr_ge0.
move=> /allP/(_ l (mem_index_enum _)); rewrite /= oppr_eq0 mulf_eq0.
by rewrite (gt_eqF (pos l nl)) => /eqP.
Qed.
(** T8, first order: with all forces positive every motion that closes no contact works against the load (W
  increases). *)
Theorem every_admissible_motion_works_against_the_load (n : nat) (G : 'M[F]_n) (load : 'rV[F]_n) (v : 'cV[F]_n) :
  G \in unitmx -> (forall l, 0 < forces G load 0 l) -> (forall l, (G *m v) l 0 <= 0) -> v != 0 -> (load *m v) 0 0 < 0.
Proof.
move=> regular pos sep nz; rewrite (power_identity regular).
have nonpos : (forces G load *m (G *m v)) 0 0 <= 0.
  by rewrite mxE -oppr_ge0 -sumrN; apply: sumr_ge0 => l _; rewrite oppr_ge0 pmulr_rle0.
rewrite lt_neqAle nonpos andbT; apply: contraNneq nz => zero.
have rest : G *m v = 0.
  apply/colP=> l; rewrite [RHS]mxE.
  have : \sum_i - (forces G load 0 i * (G *m v) i 0) = 0 by rewrite sumrN; move: zero; rewrite mxE => ->; rewrite oppr0.
  move/eqP; rewrite psumr_eq0 => [|i _]; last by rewrite oppr_ge0 pmulr_rle0.
  by move=> /allP/(_ l (mem_index_enum _)); rewrite /= oppr_eq0 mulf_eq0 (gt_eqF (pos l)) => /eqP.
by rewrite -(mulKmx regular v) rest mulmx0.
Qed.
End Interval.

Print Assumptions regular_iff_no_self_stress_no_mechanism.
Print Assumptions forces_exist_and_are_unique.
Print Assumptions forces_are_affine_in_the_load.
Print Assumptions opening_direction_is_unique.
Print Assumptions opening_has_unit_rate.
Print Assumptions power_identity.
Print Assumptions power_of_opening.
Print Assumptions reciprocity.
Print Assumptions affine_positive_between.
Print Assumptions supported_interval_ends_at_the_smallest_ratio.
Print Assumptions only_the_unloaded_contact_opens.
Print Assumptions every_admissible_motion_works_against_the_load.
