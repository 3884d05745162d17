(** Statements K4, K5 and K15 (../checker.md) for a packing in a box or a cell: one configuration with all contacts closed.

    q0 is the stored configuration, q1 a refined one, rho the radius of a ball around q0. From a bound of |A(q0) x|
    below comes one of |A(p) x| for all p of the ball; from that existence (kantorovich.v), distance and uniqueness. *)
From mathcomp Require Import all_ssreflect all_algebra ring.
From Isostat Require Import shifted_factor max_norm kantorovich contact_certificate box.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Vertex.
Variables (F : archiFieldType) (d : dimension) (n : nat) (w : F) (radius place : nat -> F) (contacts : seq contact).
Let N := (coordinates_of d n)%N.
Let C : F := (curvature d n contacts)%:R.
Variables (q0 q1 : 'cV[F]_N) (b rho r : F).
Let A := derivative w contacts : 'cV[F]_N -> 'M[F]_N.
Let gaps := gaps w radius place contacts : 'cV[F]_N -> 'cV[F]_N.
Hypothesis b0 : 0 < b.
Hypothesis strong : forall x, 2%:R * N%:R * (b ^+ 2 + C ^+ 2 * rho ^+ 2) * square x <= square (A q0 *m x).

Let N0 : 0 < N%:R :> F. Proof. by rewrite ltr0n. Qed.
Let C0 : 0 <= C. Proof. exact: ler0n. Qed.

Lemma strong_in_the_ball p x : norm (p - q0) <= rho -> N%:R * b ^+ 2 * square x <= square (A p *m x).
Proof.
move=> near; have rho0 : 0 <= rho := le_trans (norm_ge0 _) near.
have split : A q0 *m x = A p *m x - (A p *m x - A q0 *m x) by rewrite opprB addrC subrK.
have := square_add (A p *m x) (- (A p *m x - A q0 *m x)); rewrite -split => /(le_trans (strong x)).
set change := square (- _); have small : change <= C ^+ 2 * N%:R * rho ^+ 2 * square x.
  apply: le_trans (square_norm _) _; rewrite norm_opp [C ^+ 2 * _]mulrC -!mulrA ler_pmul2l //.
  apply: le_trans (_ : (C * rho * norm x) ^+ 2 <= _).
    rewrite ler_pexpn2r ?nnegrE ?norm_ge0 ?mulr_ge0 ?ler0n ?norm_ge0 //.
    apply: le_trans (derivative_is_lipschitz _ _ _ _ _) _.
    by rewrite ler_wpmul2r ?norm_ge0 // ler_wpmul2l.
  by rewrite !exprMn -!mulrA !ler_wpmul2l ?exprn_ge0 ?norm_square.
move: (square x) (square (A p *m x)) change small => s t u small.
have -> : 2%:R * N%:R * (b ^+ 2 + C ^+ 2 * rho ^+ 2) * s
   = 2%:R * (N%:R * b ^+ 2 * s) + 2%:R * (C ^+ 2 * N%:R * rho ^+ 2 * s) by ring.
rewrite -!mulrDr ler_pmul2l ?ltr0n // => sum; rewrite -(ler_add2r u); apply: le_trans sum; exact: ler_add.
Qed.

Let Nb0 : 0 < N%:R * b ^+ 2. Proof. by rewrite mulr_gt0 ?exprn_gt0. Qed.

(** A bound of squares, N times as strong as needed, bounds the largest entry. *)
Lemma entries_are_bounded (B : 'M[F]_N) x : N%:R * b ^+ 2 * square x <= square (B *m x) -> b * norm x <= norm (B *m x).
Proof.
move=> bound; rewrite -(@ler_pexpn2r _ 2) ?nnegrE ?norm_ge0 ?(mulr_ge0 (ltW b0)) ?norm_ge0 // exprMn.
rewrite -(ler_pmul2l N0); apply: le_trans (square_norm _); apply: le_trans bound.
by rewrite mulrA ler_wpmul2l ?(ltW Nb0) ?norm_square.
Qed.

Lemma regular_in_the_ball p : norm (p - q0) <= rho -> A p \in unitmx.
Proof. by move=> near; apply: (bounded_below_is_regular Nb0) => x; apply: strong_in_the_ball. Qed.

Lemma inverse_in_the_ball p x : norm (p - q0) <= rho -> b * norm x <= norm (A p *m x).
Proof. by move=> near; apply/entries_are_bounded/strong_in_the_ball. Qed.

Lemma transposed_inverse_in_the_ball p x : norm (p - q0) <= rho -> b * norm x <= norm ((A p)^T *m x).
Proof.
move=> near; apply/entries_are_bounded/(transposed_is_bounded_below Nb0) => y.
exact: strong_in_the_ball.
Qed.

Lemma roots_in_the_ball_coincide p q :
  norm (p - q0) <= rho -> norm (q - q0) <= rho -> b * norm (p - q) <= norm (gaps p - gaps q).
Proof.
move=> np nq; rewrite /gaps gaps_at_the_middle; apply: inverse_in_the_ball.
have -> : 2%:R^-1 *: (p + q) - q0 = 2%:R^-1 *: (p - q0) + 2%:R^-1 *: (q - q0).
  rewrite -scalerDr addrACA -opprD scalerBr; congr (_ - _).
  by rewrite -mulr2n -scaler_nat scalerA mulVf ?scale1r // pnatr_eq0.
apply: le_trans (norm_triangle _ _) _; rewrite !norm_scale ger0_norm ?invr_ge0 ?ler0n // -mulrDr.
by rewrite ler_pdivr_mull ?ltr0n // mulr_natl mulr2n ler_add.
Qed.

Hypothesis small : norm (gaps q1) <= b * r.
Hypothesis step : 4%:R * C * r <= b.
Hypothesis inside : norm (q1 - q0) + 2%:R * r <= rho.

Let r0 : 0 <= r. Proof. by rewrite -(pmulr_rge0 _ b0); apply: le_trans small; apply: norm_ge0. Qed.
Let near1 : norm (q1 - q0) <= rho.
Proof. by apply: le_trans inside; rewrite ler_addl mulr_ge0 ?ler0n. Qed.

Let close q : norm (q - q1) <= 2%:R * r -> norm (q - q0) <= rho.
Proof.
move=> near; rewrite -(subrKA q1); apply: le_trans (norm_triangle _ _) _.
by apply: le_trans inside; rewrite addrC ler_add2l.
Qed.

Let inverse y : b * norm (invmx (A q1) *m y) <= norm y.
Proof. by apply: le_trans (inverse_in_the_ball _ near1) _; rewrite mulKVmx ?regular_in_the_ball. Qed.

Theorem one_configuration_closes_all_contacts : complete F ->
  exists q, [/\ norm (q - q1) <= r, norm (q - q0) <= rho, gaps q = 0, A q \in unitmx
    & forall q', norm (q' - q0) <= rho -> gaps q' = 0 -> q' = q].
Proof.
move=> full; have regular1 := regular_in_the_ball near1.
have [] := @root_exists F _ (@norm F N) (@norm_triangle F N) (@norm_opp F N) (@norm_scale F N) (@norm_eq0 F N)
  gaps (fun p => [linear of mulmx (A p)]) [linear of mulmx (invmx (A q1))] q1 (C / b) r.
- by move=> p q; apply: gaps_at_the_middle.
- by move=> v; rewrite /= mulKmx.
- by move=> v /= /(congr1 (mulmx (A q1))); rewrite mulKVmx // mulmx0.
- move=> p v /=; rewrite -(ler_pmul2l b0); apply: le_trans (inverse _) _.
  apply: le_trans (derivative_is_lipschitz _ _ _ _ _) _.
  by have -> : b * (C / b * norm (p - q1) * norm v) = C * norm (p - q1) * norm v by field; rewrite gt_eqF.
- by rewrite divr_ge0 // ltW.
- by rewrite /= -(ler_pmul2l b0); apply: le_trans (inverse _) small.
- have -> : 4%:R * (C / b * r) = 4%:R * C * r / b by ring.
  by rewrite ler_pdivr_mulr // mul1r.
- by move=> u halves; apply: vectors_with_halving_steps_converge.
move=> q [near closed]; have nq := close near; exists q; split=> //; last 1 first.
- move=> q' nq' closed'; apply/eqP; rewrite -subr_eq0; apply/eqP/norm_eq0/eqP; rewrite eq_le norm_ge0 andbT.
  rewrite -(pmulr_rle0 _ b0); apply: le_trans (roots_in_the_ball_coincide nq' nq) _.
  by rewrite closed closed' subrr -(scale0r 0) norm_scale normr0 mul0r.
- rewrite -(ler_pmul2l b0); apply: le_trans (roots_in_the_ball_coincide nq near1) _.
  by rewrite closed sub0r norm_opp.
- exact: regular_in_the_ball.
Qed.
End Vertex.

Print Assumptions strong_in_the_ball.
Print Assumptions transposed_inverse_in_the_ball.
Print Assumptions one_configuration_closes_all_contacts.
