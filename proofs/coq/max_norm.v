(** Vectors with the norm of their largest entry, over an archimedean ordered field.

  [complete] says that the field has no holes: every Cauchy sequence converges. It is the only hypothesis of
    this folder that is not proved; the real numbers have it. *)
From mathcomp Require Import all_ssreflect all_algebra ring.
From Isostat Require Import shifted_factor.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Norm.
Variables (F : realFieldType) (n : nat).
Implicit Types (x y : 'cV[F]_n) (b : F).

Definition norm x : F := foldr (fun i m => Num.max `|x i 0| m) 0 (enum 'I_n).

Lemma norm_ge0 x : 0 <= norm x.
Proof. by rewrite /norm; elim: (enum _) => //= i s IH; rewrite le_maxr IH orbT. Qed.

Lemma entry_norm x i : `|x i 0| <= norm x.
Proof.
have := mem_enum 'I_n i; rewrite /norm; elim: (enum _) => //= j s IH.
by rewrite inE le_maxr => /orP[/eqP->|/IH->]; rewrite ?lexx ?orbT.
Qed.

Lemma norm_le x b : 0 <= b -> (forall i, `|x i 0| <= b) -> norm x <= b.
Proof. by move=> b0 small; rewrite /norm; elim: (enum _) => //= i s IH; rewrite le_maxl small IH. Qed.

Lemma norm_triangle x y : norm (x + y) <= norm x + norm y.
Proof.
apply: norm_le => [|i]; first by rewrite addr_ge0 ?norm_ge0.
by rewrite mxE (le_trans (ler_norm_add _ _)) ?ler_add ?entry_norm.
Qed.

Lemma norm_scale a x : norm (a *: x) = `|a| * norm x.
Proof.
rewrite /norm; elim: (enum _) => [|i s IH] /=; first by rewrite mulr0.
by rewrite mxE normrM IH maxr_pmulr ?normr_ge0.
Qed.

Lemma norm_opp x : norm (- x) = norm x.
Proof. by rewrite -scaleN1r norm_scale normrN1 mul1r. Qed.

Lemma norm_eq0 x : norm x = 0 -> x = 0.
Proof. by move=> x0; apply/colP=> i; apply/eqP; rewrite mxE -normr_le0 -x0 entry_norm. Qed.

Lemma norm_square x : norm x ^+ 2 <= square x.
Proof.
rewrite /norm; elim: (enum _) => [|i s IH] /=; first by rewrite expr0n square_ge0.
by case: (leP `|x i 0|) => // _; rewrite real_normK ?num_real // entry_square.
Qed.

Lemma square_norm x : square x <= n%:R * norm x ^+ 2.
Proof.
rewrite mulr_natl -[n in _ *+ n]card_ord -sumr_const; apply: ler_sum => i _.
by rewrite -(real_normK (num_real (x i 0))) ler_pexpn2r ?nnegrE ?norm_ge0 ?entry_norm.
Qed.
End Norm.

Section Completeness.
Variable F : archiFieldType.

Definition cauchy (u : nat -> F) := forall e, 0 < e -> exists m, forall i j, (m <= i)%N -> (m <= j)%N -> `|u i - u j| < e.
Definition limit (u : nat -> F) (l : F) := forall e, 0 < e -> exists m, forall i, (m <= i)%N -> `|u i - l| < e.
Definition complete := forall u, cauchy u -> exists l, limit u l.

Let half : F := 2%:R^-1.
Let half_gt0 : 0 < half. Proof. by rewrite invr_gt0 ltr0n. Qed.
Let half_double a : half * a + half * a = a.
Proof. by rewrite -mulrDl -mulr2n -mulr_natl mulfV ?mul1r // pnatr_eq0. Qed.

Lemma powers_of_half_vanish (a e : F) : 0 <= a -> 0 < e -> exists m, half ^+ m * a < e.
Proof.
move=> a0 e0; have := archi_boundP (divr_ge0 a0 (ltW e0)); set m := Num.bound _ => big; exists m.
rewrite /half exprVn mulrC ltr_pdivr_mulr ?exprn_gt0 ?ltr0n // mulrC -ltr_pdivr_mulr //.
by apply: lt_trans big _; rewrite -natrX ltr_nat ltn_expl.
Qed.

Section Halving.
Variables (u : nat -> F) (b : F).
Hypothesis steps : forall k, `|u k.+1 - u k| <= half ^+ k * b.
Let b0 : 0 <= b. Proof. by have := steps 0; rewrite expr0 mul1r; apply: le_trans. Qed.

Lemma halving_tail k m : `|u (k + m)%N - u k| <= half ^+ k * (2%:R * b).
Proof.
suff : `|u (k + m)%N - u k| <= (half ^+ k - half ^+ (k + m)) * (2%:R * b).
  by move=> step; apply: le_trans step _; rewrite ler_wpmul2r ?mulr_ge0 ?ler0n // ler_subl_addr ler_addl exprn_ge0 ?ltW.
elim: m => [|m IH]; first by rewrite addn0 !subrr normr0 mul0r.
rewrite addnS -(subrKA (u (k + m)%N)) (le_trans (ler_norm_add _ _)) //.
apply: le_trans (ler_add (steps _) IH) _; rewrite exprS.
have -> : half ^+ (k + m) * b = half ^+ (k + m) * half * (2%:R * b).
  by rewrite -mulrA [half * (_ * _)]mulrA mulVf ?mul1r ?pnatr_eq0.
rewrite -mulrDl ler_wpmul2r ?mulr_ge0 ?ler0n // le_eqVlt; apply/orP; left; apply/eqP.
by move: (half ^+ _) (half ^+ _) => p q; rewrite -{2}(half_double q); ring.
Qed.

Lemma halving_converges : complete -> exists l, forall k, `|u k - l| <= half ^+ k * (2%:R * b).
Proof.
case/(_ u) => [e e0|l lim].
  have [m small] := @powers_of_half_vanish (2%:R * (2%:R * b)) e (mulr_ge0 (ler0n _ 2) (mulr_ge0 (ler0n _ 2) b0)) e0.
  exists m => i j mi mj; rewrite -(subrKA (u m)); apply: le_lt_trans (ler_norm_add _ _) _.
  apply: le_lt_trans small; rewrite [`|u m - _|]distrC.
  have -> : half ^+ m * (2%:R * (2%:R * b)) = half ^+ m * (2%:R * b) + half ^+ m * (2%:R * b) by ring.
  by apply: ler_add; [rewrite -{1}(subnKC mi)|rewrite -{1}(subnKC mj)]; apply: halving_tail.
exists l => k; rewrite leNgt; apply/negP => far.
have gap : 0 < `|u k - l| - half ^+ k * (2%:R * b) by rewrite subr_gt0.
have [m near] := lim _ gap; have := near (k + m)%N (leq_addl _ _); rewrite ltNge => /negP; apply.
rewrite ler_subl_addl -(subrKA (u (k + m)%N)) (le_trans (ler_norm_add _ _)) // ler_add2r distrC.
exact: halving_tail.
Qed.
End Halving.

(** Entry by entry: what kantorovich.v asks of vectors. *)
Theorem vectors_with_halving_steps_converge (n : nat) (u : nat -> 'cV[F]_n) (b : F) : complete ->
  (forall k, norm (u k.+1 - u k) <= half ^+ k * b) ->
  exists l, forall k, norm (u k - l) <= half ^+ k * (2%:R * b).
Proof.
move=> full steps; have b0 : 0 <= b by have := steps 0%N; rewrite expr0 mul1r; apply: le_trans (norm_ge0 _).
have entries i : exists l, forall k, `|u k i 0 - l| <= half ^+ k * (2%:R * b).
  apply: halving_converges full => k; apply: le_trans (steps k).
  by have := entry_norm (u k.+1 - u k) i; rewrite !mxE.
have [l lim] := fin_all_exists entries; exists (\col_i l i) => k; apply: norm_le => [|i].
  by rewrite !mulr_ge0 ?exprn_ge0 ?ler0n // ltW.
by have := lim i k; rewrite !mxE.
Qed.
End Completeness.

Print Assumptions norm_square.
Print Assumptions square_norm.
Print Assumptions vectors_with_halving_steps_converge.
