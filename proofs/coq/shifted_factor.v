(** Statement K15 (../checker.md): a factor L of A^T A - s I, however it was made, bounds |A x| from below.

  Neither roots nor eigenvalues occur: lengths appear as their squares, over any ordered field. *)
From mathcomp Require Import all_ssreflect all_algebra ring.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Squares.
Variables (F : realFieldType) (n : nat).
Implicit Types (x y : 'cV[F]_n) (A B : 'M[F]_n).

Definition dot x y : F := \sum_i x i 0 * y i 0.
Definition square x : F := \sum_i x i 0 ^+ 2.

Lemma square_dot x : square x = dot x x. Proof. by apply: eq_bigr => i _; rewrite expr2. Qed.
Lemma dotC x y : dot x y = dot y x. Proof. by apply: eq_bigr => i _; rewrite mulrC. Qed.
Lemma dot_add x y z : dot (x + y) z = dot x z + dot y z.
Proof. by rewrite -big_split; apply: eq_bigr => i _ /=; rewrite mxE mulrDl. Qed.
Lemma dot_scale a x y : dot (a *: x) y = a * dot x y.
Proof. by rewrite mulr_sumr; apply: eq_bigr => i _; rewrite mxE mulrA. Qed.
Lemma dot_transpose A x y : dot (A *m x) y = dot x (A^T *m y).
Proof.
rewrite /dot; under eq_bigr => i _ do rewrite mxE mulr_suml.
rewrite exchange_big; apply: eq_bigr => j _ /=; rewrite mxE mulr_sumr; apply: eq_bigr => i _.
by rewrite mxE [RHS]mulrCA mulrA.
Qed.

Lemma square_ge0 x : 0 <= square x. Proof. by apply: sumr_ge0 => i _; exact: sqr_ge0. Qed.
Lemma square_le0 x : square x <= 0 -> x = 0.
Proof.
move=> le0; have /eqP : square x = 0 by apply/eqP; rewrite eq_le le0 square_ge0.
rewrite psumr_eq0 => [/allP zero|i _]; last exact: sqr_ge0.
by apply/colP=> i; rewrite mxE; apply/eqP; rewrite -sqrf_eq0; apply: (zero i (mem_index_enum i)).
Qed.
Lemma entry_square x i : x i 0 ^+ 2 <= square x.
Proof. by rewrite /square (bigD1 i) //= ler_addl; apply: sumr_ge0 => j _; exact: sqr_ge0. Qed.

(** (a + b)^2 <= 2 a^2 + 2 b^2. *)
Lemma square_add x y : square (x + y) <= 2%:R * square x + 2%:R * square y.
Proof.
rewrite /square -mulrDr -big_split mulr_sumr; apply: ler_sum => i _ /=; rewrite mxE -subr_ge0.
move: (x i 0) (y i 0) => a b; have -> : 2%:R * (a ^+ 2 + b ^+ 2) - (a + b) ^+ 2 = (a - b) ^+ 2 by ring.
exact: sqr_ge0.
Qed.

Lemma cauchy_schwarz x y : dot x y ^+ 2 <= square x * square y.
Proof.
have [y0|ypos] := lerP (square y) 0.
  by rewrite (square_le0 y0) dotC -[X in dot X _](scale0r 0) dot_scale mul0r expr0n mulr_ge0 ?square_ge0.
have := square_ge0 (square y *: x + (- dot x y) *: y).
rewrite square_dot dot_add !dot_scale ![dot _ (_ + _)]dotC !dot_add !dot_scale -!square_dot [dot y x]dotC.
set a := square x; set b := square y in ypos *; set c := dot x y.
rewrite (_ : _ + _ = b * (a * b - c ^+ 2)); last by ring.
by rewrite pmulr_rge0 ?subr_ge0.
Qed.
End Squares.

Section Shifted.
Variables (F : realFieldType) (n : nat) (A L : 'M[F]_n) (s d : F).
Definition defect := A^T *m A - s%:M - L *m L^T.
Hypothesis rows : forall i, \sum_j `|defect i j| <= d.

Let symmetric i j : defect i j = defect j i.
Proof. by rewrite -[in RHS](trmxK defect) [in RHS]mxE /defect !linearB /= !trmx_mul !trmxK tr_scalar_mx. Qed.

Let half_square (a b : F) : - (a * b) <= (a ^+ 2 + b ^+ 2) / 2%:R.
Proof.
rewrite ler_pdivl_mulr ?ltr0n // -subr_ge0.
have -> : a ^+ 2 + b ^+ 2 - - (a * b) * 2%:R = (a + b) ^+ 2 by ring.
exact: sqr_ge0.
Qed.

(** Each product of the form is at most the mean of two squares, and the form is symmetric. *)
Lemma defect_is_small (x : 'cV[F]_n) : - dot x (defect *m x) <= d * square x.
Proof.
have -> : dot x (defect *m x) = \sum_i \sum_j defect i j * (x i 0 * x j 0).
  by apply: eq_bigr => i _; rewrite mxE mulr_sumr; apply: eq_bigr => j _; rewrite mulrCA.
pose term i j := `|defect i j| * (x i 0 ^+ 2 / 2%:R).
apply: (@le_trans _ _ (\sum_i \sum_j (term i j + term j i))).
  rewrite -sumrN; apply: ler_sum => i _; rewrite -sumrN; apply: ler_sum => j _.
  rewrite /term (symmetric j i) -mulrDr -mulrDl -mulrN.
  case: (ger0P (defect i j)) => sign; first by apply: ler_wpmul2l.
  have -> : defect i j * - (x i 0 * x j 0) = - defect i j * - (- x i 0 * x j 0) by rewrite mulrNN mulNr.
  by apply: ler_wpmul2l; [rewrite oppr_ge0 ltW|rewrite -(sqrrN (x i 0))].
have -> : \sum_i \sum_j (term i j + term j i) = \sum_i (\sum_j `|defect i j|) * x i 0 ^+ 2.
  under eq_bigr => i _ do rewrite big_split.
  rewrite big_split /= [X in _ + X]exchange_big -big_split; apply: eq_bigr => i _ /=.
  rewrite -big_split mulr_suml; apply: eq_bigr => j _ /=.
  by rewrite /term -mulrDr -mulr2n -mulr_natr divfK ?pnatr_eq0.
by rewrite /square mulr_sumr; apply: ler_sum => i _; apply: ler_wpmul2r; rewrite ?sqr_ge0.
Qed.

Theorem shifted_factor_bounds_from_below (x : 'cV[F]_n) : (s - d) * square x <= square (A *m x).
Proof.
have parts : A^T *m A = s%:M + L *m L^T + defect by rewrite /defect -[_ - _ - _]addrA -opprD addrC subrK.
have small := defect_is_small x; move: defect small parts => D small parts.
rewrite [square (A *m x)]square_dot dot_transpose mulmxA parts !mulmxDl mul_scalar_mx -mulmxA dotC !dot_add dot_scale.
have -> : dot (L *m (L^T *m x)) x = square (L^T *m x) by rewrite dot_transpose square_dot.
rewrite -square_dot mulrBl ler_add //; first by rewrite ler_addl square_ge0.
by rewrite ler_oppl dotC.
Qed.
End Shifted.

Section BoundedBelow.
Variables (F : realFieldType) (n : nat) (A : 'M[F]_n) (k : F).
Hypothesis k0 : 0 < k.
Hypothesis below : forall x : 'cV[F]_n, k * square x <= square (A *m x).

Theorem bounded_below_is_regular : A \in unitmx.
Proof.
have zero (x : 'cV[F]_n) : A *m x = 0 -> x = 0.
  move=> Ax; apply: square_le0; rewrite -(pmulr_rle0 _ k0); apply: le_trans (below x) _.
  by rewrite Ax square_dot -[X in dot X _](scale0r 0) dot_scale mul0r.
rewrite -unitmx_tr -row_free_unit -kermx_eq0; apply/eqP/row_matrixP=> i; rewrite row0.
apply/trmx_inj; rewrite trmx0; apply: zero.
by apply/trmx_inj; rewrite trmx0 trmx_mul trmxK -row_mul mulmx_ker row0.
Qed.

(** The same bound for the transposed matrix: |x|^2 = A^T x . y with A y = x, and Cauchy and Schwarz. *)
Theorem transposed_is_bounded_below (x : 'cV[F]_n) : k * square x <= square (A^T *m x).
Proof.
pose y := invmx A *m x; have Ay : A *m y = x by rewrite mulKVmx ?bounded_below_is_regular.
have [x0|pos] := lerP (square x) 0.
  by apply: le_trans (square_ge0 _); rewrite pmulr_rle0.
rewrite -(ler_pmul2r pos) -mulrA -expr2; have -> : square x = dot (A^T *m x) y.
  by rewrite dot_transpose trmxK Ay square_dot.
apply: le_trans (ler_wpmul2l (ltW k0) (cauchy_schwarz _ _)) _.
rewrite dot_transpose trmxK Ay -square_dot mulrCA; apply: ler_wpmul2l; first exact: square_ge0.
by rewrite -Ay; apply: below.
Qed.
End BoundedBelow.

Print Assumptions shifted_factor_bounds_from_below.
Print Assumptions bounded_below_is_regular.
Print Assumptions transposed_is_bounded_below.
