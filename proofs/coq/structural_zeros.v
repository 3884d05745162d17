(** Statement T11 (a) (../structural_zeros.md): forces that no loaded row reaches vanish.

    [M] matches rows to columns. [column] are the reached columns,
      [row r] says that the column matched to r is reached. The two hypotheses
    are what the search of the code ensures: entries of reached columns lie in their rows only,
      and the load acts on these rows only. *)
From mathcomp Require Import all_ssreflect fingroup perm all_algebra.
Set Implicit Arguments.
Unset Strict Implicit.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Unreached.
Variables (F : fieldType) (n : nat) (A : 'M[F]_n) (b : 'cV[F]_n) (M : 'S_n) (column : pred 'I_n).
Let row r := column (M r).
Hypothesis closed : forall r c, column c -> ~~ row r -> A r c = 0.
Hypothesis load : forall r, ~~ row r -> b r 0 = 0.
Hypothesis regular : A \in unitmx.

Let unreached_rows : 'M[F]_n := diag_mx (\row_r (~~ row r)%:R).
Let unreached_columns : 'M[F]_n := diag_mx (\row_c (~~ column c)%:R).

Let same_rank : \rank (unreached_rows *m A) = \rank unreached_columns.
Proof.
rewrite mxrankMfree ?row_free_unit //.
have -> : unreached_rows = perm_mx M *m unreached_columns *m perm_mx M^-1%g.
  rewrite -row_permE -col_permE; apply/matrixP=> r s.
  by rewrite !mxE (inj_eq perm_inj) /row.
by rewrite mxrankMfree ?row_free_unit ?unitmx_perm // -mxrank_tr trmx_mul mxrankMfree ?mxrank_tr // row_free_unit
  unitmx_tr unitmx_perm.
Qed.

Let inside : (unreached_rows *m A <= unreached_columns)%MS.
Proof.
have -> : unreached_rows *m A = unreached_rows *m A *m unreached_columns; last exact: submxMl.
apply/matrixP=> r c; rewrite mul_mx_diag !mul_diag_mx !mxE.
case: (boolP (column c)) => [cc|_]; last by rewrite mulr1.
by case: (boolP (row r)) => [_|nr]; rewrite ?mul0r // (closed cc nr) !mulr0 ?mul0r.
Qed.

Theorem unreached_unknowns_vanish (x : 'cV[F]_n) (c : 'I_n) : A *m x = b -> ~~ column c -> x c 0 = 0.
Proof.
move=> Ax nc.
have eqm : (unreached_rows *m A == unreached_columns)%MS by rewrite -(mxrank_leqif_eq inside) same_rank.
have : ((delta_mx 0 c : 'rV[F]_n) <= unreached_rows *m A)%MS.
  case/andP: eqm => _; move=> back; apply: submx_trans back; have ->
    : delta_mx 0 c = delta_mx 0 c *m unreached_columns :> 'rV_n; last exact: submxMl.
  apply/rowP=> k; rewrite mul_mx_diag !mxE eqxx /=.
  by case: eqP => [->|_]; rewrite ?nc ?mulr1 ?mul0r.
case/submxP=> y E; have : ((delta_mx 0 c : 'rV[F]_n) *m x) 0 0 = (y *m (unreached_rows *m b)) 0 0 by rewrite E -Ax
  !mulmxA.
rewrite -rowE mxE => ->.
have -> : unreached_rows *m b = 0; last by rewrite mulmx0 mxE.
apply/colP=> r; rewrite mul_diag_mx !mxE.
by case: (boolP (row r)) => [_|nr]; rewrite ?mul0r // load ?mulr0.
Qed.
End Unreached.

Print Assumptions unreached_unknowns_vanish.
