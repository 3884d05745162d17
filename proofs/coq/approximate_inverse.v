(** Statement V2 (../bounds.md), in the infinity norm: an approximate inverse R proves that H is regular and bounds
  the solutions of H x = b.
    For the 1 norm apply it to the transposed matrices. *)
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section ApproximateInverse.
Variables (F : realFieldType) (n : nat) (R H : 'M[F]_n) (e rho : F).
Hypothesis defect : forall i, \sum_j `|(R *m H - 1%:M) i j| <= e.
Hypothesis small : e < 1.
Hypothesis size : forall i, \sum_j `|R i j| <= rho.

Theorem solutions_are_bounded (x b : 'cV[F]_n) (beta : F) :
  H *m x = b -> (forall i, `|b i 0| <= beta) -> forall i, `|x i 0| <= rho * beta / (1 - e).
Proof.
move=> Hx bb i.
pose k := [arg max_(j > i) `|x j 0|]%O.
have kmax j : `|x j 0| <= `|x k 0|.
  by rewrite /k; case: arg_maxP => // m _ /(_ j); apply.
apply: le_trans (kmax i) _; rewrite ler_pdivl_mulr ?subr_gt0 // mulrBr mulr1 ler_subl_addr.
have step : x = R *m b - (R *m H - 1%:M) *m x by rewrite -Hx mulmxBl mul1mx mulmxA opprB addrC subrK.
move: (R *m H - 1%:M) defect step => D dD step.
have entry (A : 'M[F]_n) (y : 'cV[F]_n) (s t : F) :
    (forall l, \sum_j `|A l j| <= s) -> (forall j, `|y j 0| <= t) -> `|(A *m y) k 0| <= s * t.
  move=> As yt; have t0 : 0 <= t := le_trans (normr_ge0 _) (yt k).
  rewrite mxE; apply: le_trans (ler_norm_sum _ _ _) _.
  apply: (@le_trans _ _ (\sum_j `|A k j| * t)); last by rewrite -mulr_suml ler_wpmul2r.
  by apply: ler_sum => j _; rewrite normrM ler_wpmul2l.
have split : x k 0 = (R *m b) k 0 - (D *m x) k 0 by rewrite {1}step; move: (R *m b) (D *m x) => y z; rewrite !mxE.
have split_norm : `|x k 0| <= `|(R *m b) k 0| + `|(D *m x) k 0| by rewrite {1}split ler_norm_sub.
by apply: le_trans split_norm _; apply: ler_add; [exact: entry|rewrite mulrC; exact: entry].
Qed.

Theorem approximate_inverse_proves_regular : H \in unitmx.
Proof.
have zero (x : 'cV[F]_n) : H *m x = 0 -> x = 0.
  move=> Hx; apply/colP=> i; rewrite mxE.
  have := @solutions_are_bounded x 0 0 Hx _ i; rewrite mulr0 mul0r => bound.
  by apply/eqP; rewrite -normr_le0; apply: bound => j; rewrite mxE normr0.
rewrite -unitmx_tr -row_free_unit -kermx_eq0; apply/eqP/row_matrixP=> i; rewrite row0.
apply/trmx_inj; rewrite trmx0; apply: zero.
by apply/trmx_inj; rewrite trmx_mul trmxK trmx0 -row_mul mulmx_ker row0.
Qed.
End ApproximateInverse.

Print Assumptions solutions_are_bounded.
Print Assumptions approximate_inverse_proves_regular.
