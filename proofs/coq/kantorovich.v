(** Statements T9 and V4 (../bounds.md): a true configuration near the stored one.

    The gaps as quadratics: F x - F y = J ((x + y) / 2) (x - y) with the derivative J,
      and J is Lipschitz. The code accepts when
    h = beta K eta <= 1/4 and then uses the radii 2 eta, 1.18 eta or (1 + h) eta; the chord iteration x ->
      x - R (F x), R the inverse of J c, contracts. Other roots are excluded within 1.7 / (beta K), or in the open ball
      of radius 1 / (beta K), because J is regular in the middle between two roots. *)
From mathcomp Require Import all_ssreflect all_algebra ring.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Chord.
Variables (K : archiFieldType) (V : lmodType K) (N : V -> K).
Hypothesis norm_triangle : forall x y, N (x + y) <= N x + N y.
Hypothesis norm_opp : forall x, N (- x) = N x.
Hypothesis norm_scale : forall a x, N (a *: x) = `|a| * N x.
Hypothesis norm_eq0 : forall x, N x = 0 -> x = 0.

Variables (gaps : V -> V) (J : V -> {linear V -> V}) (R : {linear V -> V}) (c : V) (lip eta : K).
Hypothesis midpoint : forall x y, gaps x - gaps y = J (2%:R^-1 *: (x + y)) (x - y).
Hypothesis inverse : forall v, R (J c v) = v.
Hypothesis inverse_injective : forall v, R v = 0 -> v = 0.
(** [lip] is beta K. *)
Hypothesis lipschitz : forall p v, N (R (J p v - J c v)) <= lip * N (p - c) * N v.
Hypothesis lip_ge0 : 0 <= lip.
Hypothesis first_step : N (R (gaps c)) <= eta.
Hypothesis small : 4%:R * (lip * eta) <= 1.

Definition chord (x : V) := x - R (gaps x).
Let half : K := 2%:R^-1.
Let half_ge0 : 0 <= half. Proof. by rewrite invr_ge0 ler0n. Qed.
Let norm_ge0 x : 0 <= N x.
Proof.
have := norm_triangle x (- x); rewrite subrr norm_opp.
have -> : N 0 = 0 by rewrite -(scale0r (0 : V)) norm_scale normr0 mul0r.
by rewrite -mulr2n pmulrn_lge0.
Qed.
Let eta_ge0 : 0 <= eta := le_trans (norm_ge0 _) first_step.
Let norm_sub x y z : N (x - z) <= N (x - y) + N (y - z).
Proof. by have := norm_triangle (x - y) (y - z); rewrite addrA subrK. Qed.
Let norm_sym x y : N (x - y) = N (y - x). Proof. by rewrite -norm_opp opprB. Qed.

Let middle x y : half *: (x + y) - c = half *: (x - c) + half *: (y - c).
Proof.
rewrite -scalerDr addrACA -opprD scalerBr; congr (_ - _).
by rewrite -mulr2n -scaler_nat scalerA /half mulVf ?scale1r // pnatr_eq0.
Qed.

Lemma chord_difference x y : N (chord x - chord y) <= lip * (half * (N (x - c) + N (y - c))) * N (x - y).
Proof.
have -> : chord x - chord y = - R (J (half *: (x + y)) (x - y) - J c (x - y)).
  rewrite [R (_ - _)]raddfB /= inverse -midpoint [R (gaps x - gaps y)]raddfB /= /chord !opprB.
  by rewrite [_ - y]addrC addrACA; congr (_ + _); rewrite addrC.
rewrite norm_opp; apply: le_trans (lipschitz _ _) _.
apply: ler_wpmul2r; first exact: norm_ge0.
apply: ler_wpmul2l => //.
rewrite middle; apply: le_trans (norm_triangle _ _) _.
by rewrite !norm_scale ger0_norm // mulrDr.
Qed.

Let radius : K := 2%:R * eta.
Definition near (x : V) := N (x - c) <= radius.

Let lip_radius : lip * radius <= half.
Proof.
rewrite -[half]mulr1 /half ler_pdivl_mull ?ltr0n //.
by have -> : 2%:R * (lip * radius) = 4%:R * (lip * eta) by rewrite /radius; ring.
Qed.

Theorem chord_contracts x y : near x -> near y -> N (chord x - chord y) <= half * N (x - y).
Proof.
move=> nx ny; apply: le_trans (chord_difference x y) _; apply: ler_wpmul2r; first exact: norm_ge0.
apply: le_trans lip_radius; apply: ler_wpmul2l => //.
have -> : radius = half * (radius + radius) by rewrite -mulr2n -mulr_natl mulrA mulVf ?mul1r // pnatr_eq0.
by apply: ler_wpmul2l => //; apply: ler_add.
Qed.

Let near_c : near c.
Proof.
rewrite /near subrr; have := norm_scale 0 0; rewrite scale0r normr0 mul0r => ->.
by rewrite /radius mulr_ge0 ?ler0n.
Qed.

Theorem chord_stays_near x : near x -> near (chord x).
Proof.
move=> nx; apply: le_trans (norm_sub _ (chord c) _) _.
have -> : radius = half * radius + eta by rewrite {1}/radius mulr_natl mulr2n {1 2}(_ : eta = half * radius) //
  /radius mulrA mulVf ?mul1r // pnatr_eq0.
apply: ler_add.
  by apply: le_trans (chord_contracts nx near_c) _; apply: ler_wpmul2l.
by rewrite /chord addrC addKr norm_opp.
Qed.

Definition iterate (k : nat) := iter k chord c.

Theorem iterates_stay_near k : near (iterate k).
Proof. by elim: k => [|k IH]; [exact: near_c|exact: chord_stays_near IH]. Qed.

Theorem steps_are_halved k : N (iterate k.+1 - iterate k) <= half ^+ k * eta.
Proof.
elim: k => [|k IH].
  by rewrite expr0 mul1r /iterate /= /chord addrC addKr norm_opp.
have step m : iterate m.+1 = chord (iterate m) by [].
rewrite (step k.+1) {2}(step k); apply: le_trans (chord_contracts (iterates_stay_near _) (iterates_stay_near _)) _.
by rewrite exprS -mulrA; apply: ler_wpmul2l.
Qed.

Let root_is_fixed x : gaps x = 0 -> chord x = x. Proof. by rewrite /chord => ->; rewrite raddf0 subr0. Qed.

Let double_half a : 2%:R * (half * a) = a. Proof. by rewrite mulrA /half mulfV ?mul1r // pnatr_eq0. Qed.

(** Two roots whose mean lies where J is regular are one: no fixed point is needed. *)
Theorem roots_coincide x y : gaps x = 0 -> gaps y = 0 -> lip * (N (x - c) + N (y - c)) < 2%:R -> x = y.
Proof.
move=> rx ry close; apply/eqP; rewrite -subr_eq0; apply/eqP/norm_eq0/eqP.
rewrite eq_le norm_ge0 andbT leNgt; apply/negP => pos.
have := chord_difference x y; rewrite !root_is_fixed // -{1}(mul1r (N _)) ler_pmul2r // leNgt => /negP; apply.
by rewrite -(ltr_pmul2l (ltr0n K 2)) mulr1 mulrCA double_half.
Qed.

(** At most one root in the open ball of radius 1 / (beta K): arcs. *)
Theorem root_is_unique_in_the_open_ball x y : lip * N (x - c) < 1 -> lip * N (y - c) < 1 ->
  gaps x = 0 -> gaps y = 0 -> x = y.
Proof.
move=> nx ny rx ry; apply: roots_coincide => //.
by rewrite mulrDr (_ : 2%:R = 1 + 1) ?ltr_add // -mulr2n.
Qed.

Let step_to_a_root x : gaps x = 0 -> N (x - c) <= half * (lip * N (x - c) ^+ 2) + eta.
Proof.
move=> rx; apply: le_trans (norm_sub _ (chord c) _) _; apply: ler_add; last by rewrite /chord addrC addKr norm_opp.
have := chord_difference x c; rewrite root_is_fixed // subrr.
have := norm_scale 0 0; rewrite scale0r normr0 mul0r => ->; rewrite addr0 => step; apply: le_trans step _.
by rewrite expr2 mulrCA !mulrA.
Qed.

(** A root near c is as near as the quadratic says: a may be any number with a >= lip a^2 / 2 + eta. *)
Theorem root_is_nearer a x : near x -> gaps x = 0 -> half * (lip * a ^+ 2) + eta <= a -> N (x - c) <= a.
Proof.
move=> nx rx ha; rewrite leNgt; apply/negP => far; set t := N (x - c) in far *.
have ht : t <= half * (lip * t ^+ 2) + eta := step_to_a_root rx.
have a0 : 0 <= a by apply: le_trans ha; apply: addr_ge0 => //; apply: mulr_ge0 => //; apply: mulr_ge0 => //; apply: sqr_ge0.
have low : t - a <= half * (lip * (t + a)) * (t - a).
  have -> : half * (lip * (t + a)) * (t - a) = (half * (lip * t ^+ 2) + eta) - (half * (lip * a ^+ 2) + eta) by ring.
  by apply: ler_sub.
have : 1 <= half * (lip * (t + a)) by move: low; rewrite -{1}(mul1r (t - a)) ler_pmul2r // subr_gt0.
rewrite leNgt => /negP; apply; apply: le_lt_trans (_ : half < 1); last by rewrite invf_lt1 ?ltr0n // ltr1n.
rewrite -[X in _ <= X]mulr1; apply: ler_wpmul2l => //; apply: le_trans (_ : lip * (radius + radius) <= _).
  by apply: ler_wpmul2l => //; apply: ler_add => //; apply: le_trans nx; apply: ltW.
by have -> : lip * (radius + radius) = 4%:R * (lip * eta) by rewrite /radius; ring.
Qed.

Let h_le_quarter : lip * eta <= 4%:R^-1.
Proof. by rewrite -(ler_pmul2l (ltr0n K 4)) mulfV ?pnatr_eq0. Qed.

Corollary root_is_within_eta_times_1_plus_h x : near x -> gaps x = 0 -> N (x - c) <= eta * (1 + lip * eta).
Proof.
move=> nx rx; apply: root_is_nearer => //; set h := lip * eta.
have h0 : 0 <= h by apply: mulr_ge0.
have h1 : h <= 1 by apply: le_trans small; rewrite ler_pemull // ler1n.
rewrite -subr_ge0 (_ : _ - _ = half * (eta * h) * (2%:R - (1 + h) ^+ 2) + (1 - 2%:R * half) * (eta * h)); last first.
  by rewrite /h; ring.
rewrite /half mulfV ?pnatr_eq0 // subrr mul0r addr0 mulr_ge0 ?mulr_ge0 // subr_ge0.
apply: le_trans (_ : (1 + 4%:R^-1) ^+ 2 <= _).
  by rewrite ler_pexpn2r ?nnegrE ?addr_ge0 ?ler01 ?invr_ge0 ?ler0n // ler_add2l.
have -> : (1 + 4%:R^-1) ^+ 2 = 25%:R / 16%:R :> K by field; rewrite ?pnatr_eq0.
by rewrite ler_pdivr_mulr ?ltr0n // -natrM ler_nat.
Qed.

Corollary root_is_within_118_eta x : near x -> gaps x = 0 -> N (x - c) <= 59%:R / 50%:R * eta.
Proof.
move=> nx rx; apply: root_is_nearer => //; rewrite -subr_ge0.
have -> : 59%:R / 50%:R * eta - (half * (lip * (59%:R / 50%:R * eta) ^+ 2) + eta)
    = eta * (9%:R / 50%:R - 3481%:R / 5000%:R * (lip * eta)).
  by rewrite /half; field; rewrite ?pnatr_eq0.
apply: mulr_ge0 => //; rewrite subr_ge0.
apply: le_trans (_ : 3481%:R / 5000%:R * 4%:R^-1 <= _).
  by apply: ler_wpmul2l h_le_quarter; rewrite divr_ge0 ?ler0n.
have -> : 3481%:R / 5000%:R * 4%:R^-1 = 3481%:R / 20000%:R :> K by field; rewrite ?pnatr_eq0.
rewrite ler_pdivr_mulr ?ltr0n // mulrAC ler_pdivl_mulr ?ltr0n //.
by rewrite -!natrM ler_nat; vm_compute.
Qed.

(** The root near c is the only one within 1.7 / (beta K) of c, the border included: certificates. *)
Theorem no_other_root_within_17_tenths x y : near x -> gaps x = 0 -> gaps y = 0 ->
  lip * N (y - c) <= 17%:R / 10%:R -> x = y.
Proof.
move=> nx rx ry far; apply: roots_coincide => //; rewrite mulrDr.
apply: le_lt_trans (_ : 59%:R / 50%:R * 4%:R^-1 + 17%:R / 10%:R < _).
  apply: ler_add => //; apply: le_trans (_ : lip * (59%:R / 50%:R * eta) <= _).
    by apply: ler_wpmul2l => //; apply: root_is_within_118_eta.
  by rewrite mulrCA; apply: ler_wpmul2l h_le_quarter; rewrite divr_ge0 ?ler0n.
have -> : 59%:R / 50%:R * 4%:R^-1 + 17%:R / 10%:R = 399%:R / 200%:R :> K by field; rewrite ?pnatr_eq0.
by rewrite ltr_pdivr_mulr ?ltr0n // -natrM ltr_nat; vm_compute.
Qed.

(** At most one root within 2 eta. *)
Theorem root_is_unique x y : near x -> near y -> gaps x = 0 -> gaps y = 0 -> x = y.
Proof.
move=> nx ny rx ry; apply: root_is_unique_in_the_open_ball => //.
  by apply: le_lt_trans (ler_wpmul2l lip_ge0 nx) (le_lt_trans lip_radius _); rewrite invf_lt1 ?ltr0n // ltr1n.
by apply: le_lt_trans (ler_wpmul2l lip_ge0 ny) (le_lt_trans lip_radius _); rewrite invf_lt1 ?ltr0n // ltr1n.
Qed.

(** A root within 2 eta, where sequences with halving steps have a limit (real vectors do). *)
Hypothesis complete : forall x : nat -> V, (forall k, N (x k.+1 - x k) <= half ^+ k * eta) ->
  exists l, forall k, N (x k - l) <= half ^+ k * (2%:R * eta).

Theorem root_exists : exists x, near x /\ gaps x = 0.
Proof.
have [l lim] := complete steps_are_halved; exists l.
have nl : near l by have := lim 0%N; rewrite expr0 mul1r norm_sym.
split=> //; apply: inverse_injective.
have fixed : N (chord l - l) = 0.
  apply/eqP; rewrite eq_le norm_ge0 andbT leNgt; apply/negP => pos.
  have bound k : N (chord l - l) <= half ^+ k * radius.
    apply: le_trans (norm_sub _ (chord (iterate k)) _) _.
    have -> : half ^+ k * radius = half * (half ^+ k * radius) + half ^+ k.+1 * radius.
      by rewrite exprS mulrA -mulrDl -mulrDl -mulr2n -mulr_natl /half mulfV ?mul1r ?pnatr_eq0.
    apply: ler_add; last exact: (lim k.+1).
    apply: le_trans (chord_contracts nl (iterates_stay_near k)) _.
    by apply: ler_wpmul2l => //; rewrite norm_sym; apply: lim.
  have := archi_boundP (divr_ge0 (mulr_ge0 (ler0n K 2) eta_ge0) (norm_ge0 (chord l - l))).
  set m := Num.bound _; rewrite ltr_pdivr_mulr // => big.
  have := bound m; rewrite /half exprVn -ler_pdivr_mull ?invr_gt0 ?exprn_gt0 ?ltr0n // invrK => contra.
  move: big; rewrite ltNge => /negP; apply; apply: le_trans contra.
  by rewrite ler_pmul2r // -natrX ler_nat ltnW // ltn_expl.
by have := norm_eq0 fixed; rewrite /chord addrC addKr => /eqP; rewrite oppr_eq0 => /eqP.
Qed.
End Chord.

(** The quadratic of a contact has this form: its difference is its derivative in the middle,
  applied to the difference. *)
Lemma quadratic_of_a_contact_at_the_middle (K : fieldType) (D x1 x2 y1 y2 : K) : 2%:R != 0 :> K -> D != 0 ->
  (x1 ^+ 2 + x2 ^+ 2 - D ^+ 2) / (2%:R * D) - (y1 ^+ 2 + y2 ^+ 2 - D ^+ 2) / (2%:R * D)
    = 2%:R^-1 * (x1 + y1) / D * (x1 - y1) + 2%:R^-1 * (x2 + y2) / D * (x2 - y2).
Proof. by move=> two D0; field; rewrite two D0. Qed.

Print Assumptions chord_contracts.
Print Assumptions chord_stays_near.
Print Assumptions iterates_stay_near.
Print Assumptions steps_are_halved.
Print Assumptions roots_coincide.
Print Assumptions root_is_unique_in_the_open_ball.
Print Assumptions root_is_nearer.
Print Assumptions root_is_within_eta_times_1_plus_h.
Print Assumptions root_is_within_118_eta.
Print Assumptions no_other_root_within_17_tenths.
Print Assumptions root_is_unique.
Print Assumptions root_exists.
Print Assumptions quadratic_of_a_contact_at_the_middle.
