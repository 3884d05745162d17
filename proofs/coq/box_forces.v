(** Statements K6 and K7 (../checker.md) for a packing in a box or a cell: forces at the true vertex.

    q is the true vertex, q1 a configuration within r of it. Forces that balance a load exist once; approximate ones
    whose residual at q1 is small are near them. Forces of a set of contacts vanish exactly where as many unloaded
    degrees of freedom are touched by no other contact. *)
From mathcomp Require Import all_ssreflect all_algebra ring.
From mathcomp Require Import zify.
From Isostat Require Import shifted_factor max_norm contact_certificate box.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(** Independent rows that vanish outside as many columns T: what they take to 0 is 0 in T. *)
Lemma independent_rows_vanish (F : fieldType) (k m : nat) (R : 'M[F]_(k, m)) (T : {set 'I_m}) : row_free R -> k = #|T| ->
  (forall a j, j \notin T -> R a j = 0) -> forall x : 'cV[F]_m, R *m x = 0 -> forall j, j \in T -> x j 0 = 0.
Proof.
move=> /eqP free same outside x zero j jT; pose units : 'M[F]_(#|T|, m) := rowsub enum_val 1%:M.
have inside : (R <= units)%MS.
  have -> : R = (\matrix_(a, z) R a (enum_val z)) *m units; last exact: submxMl.
  apply/matrixP=> a i; rewrite [RHS]mxE; have [iT|iT] := boolP (i \in T).
    rewrite (bigD1 (enum_rank_in iT i)) //= !mxE enum_rankK_in // eqxx mulr1 big1 ?addr0 // => z ne; rewrite !mxE.
    case: eqP => [zi|]; last by rewrite mulr0.
    by case/eqP: ne; apply: enum_val_inj; rewrite enum_rankK_in.
  rewrite big1 => [|z _]; first exact: outside.
  by rewrite !mxE; case: eqP => [zi|]; rewrite ?mulr0 //; case/negP: iT; rewrite -zi enum_valP.
have back : (units <= R)%MS.
  have : (R == units)%MS by rewrite -(mxrank_leqif_eq inside) eqn_leq mxrankS //= free same rank_leq_row.
  by case/andP.
have /submxP[y ey] := submx_trans (row_sub (enum_rank_in jT j) units) back.
have -> : x j 0 = (row (enum_rank_in jT j) units *m x) 0 0.
  by rewrite row_rowsub enum_rankK_in // row1 -rowE mxE.
by rewrite ey -mulmxA zero mulmx0 mxE.
Qed.

Section Blocks.
Variables (F : fieldType) (m : nat) (X : 'M[F]_m) (S T : {set 'I_m}).
Hypothesis unit : X \in unitmx.
Hypothesis outside : forall i j, i \in S -> j \notin T -> X i j = 0.
Let rows : 'M[F]_(#|S|, m) := rowsub enum_val X.

Let rows_free : row_free rows.
Proof.
rewrite /rows /row_free; have -> : rowsub enum_val X = rowsub (@enum_val _ (mem S)) 1%:M *m X by rewrite mul_rowsub_mx mul1mx.
rewrite mxrankMfree ?row_free_unit //; apply/row_freeP; exists (rowsub enum_val 1%:M)^T.
apply/matrixP=> a z; rewrite !mxE (bigD1 (enum_val a)) //= !mxE eqxx mul1r big1 ?addr0 => [|k ne].
  by rewrite (inj_eq enum_val_inj) eq_sym.
by rewrite !mxE [enum_val a == k]eq_sym (negPf ne) mul0r.
Qed.
Let rows_outside a j : j \notin T -> rows a j = 0.
Proof. by move=> jT; rewrite mxE outside ?enum_valP. Qed.
Let rows_zero (x : 'cV[F]_m) : (forall i, i \in S -> (X *m x) i 0 = 0) -> rows *m x = 0.
Proof. by move=> zero; rewrite mul_rowsub_mx; apply/colP=> a; rewrite mxE zero ?enum_valP // mxE. Qed.

(** A regular matrix whose rows S vanish outside as many columns T: solutions with zeros in S have zeros in T. *)
Lemma block_solutions_vanish : #|S| = #|T| ->
  forall x : 'cV[F]_m, (forall i, i \in S -> (X *m x) i 0 = 0) -> forall j, j \in T -> x j 0 = 0.
Proof. by move=> same x /rows_zero; apply: independent_rows_vanish rows_free same rows_outside _. Qed.

(** One column more: such solutions are multiples of one vector in T, so that they vanish there together. *)
Lemma block_solutions_vary_together : #|T| = #|S|.+1 -> forall x y : 'cV[F]_m,
  (forall i, i \in S -> (X *m x) i 0 = 0) -> (forall i, i \in S -> (X *m y) i 0 = 0) ->
  forall k, k \in T -> y k 0 != 0 -> x k 0 = 0 -> forall j, j \in T -> x j 0 = 0.
Proof.
move=> more x y /rows_zero x0 /rows_zero y0 k kT yk xk.
apply: (@independent_rows_vanish _ (1 + #|S|) _ (col_mx (delta_mx 0 k) rows)) => [||a j jT|].
- apply: inj_row_free => v; rewrite -[v]hsubmxK mul_row_col => sum.
  have left : lsubmx v = 0.
    have := congr1 (fun r : 'rV_m => (r *m y) 0 0) sum.
    rewrite mul0mx mulmxDl -!mulmxA y0 mulmx0 addr0 -rowE [LHS]mxE big_ord1 [X in _ * X = _]mxE [RHS]mxE => /eqP.
    rewrite mulf_eq0 (negPf yk) orbF => /eqP zero; apply/rowP=> i.
    by rewrite [i]ord1 [RHS]mxE.
  rewrite left mul0mx add0r in sum *; have /row_freeP[R' rr] := rows_free.
  by have := congr1 (mulmx^~ R') sum; rewrite mul0mx -mulmxA rr mulmx1 => ->; rewrite row_mx0.
- by rewrite more.
- rewrite mxE; case: split => b; last exact: rows_outside.
  by rewrite mxE; have [jk|_] := eqVneq j k; rewrite ?andbF //; case/negP: jT; rewrite jk.
by rewrite mul_col_mx x0 -rowE; apply/colP=> a; rewrite mxE; case: split => b; rewrite ?mxE.
Qed.
End Blocks.

Section Forces.
Variables (F : realFieldType) (d : dimension) (n : nat) (w : F) (radius : nat -> F) (contacts : seq contact).
Let N := (coordinates_of d n)%N.
Variables (q q1 : 'cV[F]_N) (b r : F).
Let A := derivative w contacts : 'cV[F]_N -> 'M[F]_N.
Let scale_at (l : nat) : F := scale w radius (contact_at contacts l).

(** In every degree of freedom the forces, along the normals, and the load sum to 0. *)
Definition balanced (load f : 'cV[F]_N) : Prop := (normals radius contacts q)^T *m f + load = 0.

Hypothesis w0 : w != 0.
Hypothesis scales : forall l, scale 1 radius (contact_at contacts l) != 0.
Hypothesis regular : normals radius contacts q \in unitmx.

Theorem balancing_forces_are_unique load f f' : balanced load f -> balanced load f' -> f = f'.
Proof.
have unit : (normals radius contacts q)^T \in unitmx by rewrite unitmx_tr.
by move=> e e'; rewrite -(mulKmx unit f) -(mulKmx unit f'); congr (_ *m _); apply: (addIr load); rewrite e.
Qed.

Lemma entry_moves_little l (m : 'I_N) : norm (q - q1) <= r ->
  `|A q l m - A q1 l m| <= r * (\sum_(e <- entry_changes d n (contact_at contacts l) | e.1 == m) e.2)%:R.
Proof.
move=> near; rewrite !mxE; case: (contact_at contacts l) => [i j k k' k''|i a|i a|k];
  rewrite /= ?subrr ?normr0 ?big_nil ?mulr0 //.
have moved a : `|separation d n (at_ q) i j k k' k'' a - separation d n (at_ q1) i j k k' k'' a|
    <= (spread (along d n i j k k' k'' a))%:R * r.
  rewrite /separation -sum_at_sub; apply: sum_at_bound => c.
  by apply: le_trans near; apply: at_norm.
have lists (s : seq (nat * int)) t (u z : F) : `|u - z| <= t%:R * r ->
    `|\sum_(e <- [seq (e.1, u *~ e.2) | e <- s] | e.1 == m) e.2 - \sum_(e <- [seq (e.1, z *~ e.2) | e <- s] | e.1 == m) e.2|
      <= r * (\sum_(e <- [seq (e.1, `|e.2| * t)%N | e <- s] | e.1 == m) e.2)%:R.
  move=> small; elim: s => [|e s IH] /=; first by rewrite !big_nil subrr normr0 mulr0.
  rewrite !big_cons /=; case: ifP => _ //; rewrite natrD mulrDr opprD addrACA.
  apply: le_trans (ler_norm_add _ _) _; apply: ler_add IH.
  rewrite -mulrzBl -mulrzr normrM -intr_norm natrM natr_absz mulrC mulrCA [r * _]mulrC.
  by rewrite ler_wpmul2l ?ler0z.
rewrite !big_axes !overE -sumrB; apply: le_trans (ler_norm_sum _ _ _) _.
have -> : (\sum_(e <- flatten [seq [seq (e.1, `|e.2| * spread (along d n i j k k' k'' a))%N | e <- along d n i j k k' k'' a]
    | a <- iota 0 d] | e.1 == m) e.2)%:R
  = over d (fun a => (\sum_(e <- [seq (e.1, `|e.2| * spread (along d n i j k k' k'' a))%N | e <- along d n i j k k' k'' a]
    | e.1 == m) e.2)%:R) :> F.
  by rewrite big_flatten big_map /over; elim: (iota 0 d) => [|a s IH]; rewrite ?big_nil // big_cons natrD IH.
by rewrite overE mulr_sumr; apply: ler_sum => a _; apply/lists/moved.
Qed.

Hypothesis b0 : 0 < b.
Hypothesis inverse : forall x, b * norm x <= norm ((A q)^T *m x).
Hypothesis near : norm (q - q1) <= r.

Theorem forces_are_enclosed (load G : 'cV[F]_N) (fraction c : F) : 0 <= c ->
  (forall k, `|fraction * load k 0 + ((A q1)^T *m G) k 0|
     + \sum_(l < N) r * (\sum_(e <- entry_changes d n (contact_at contacts l) | e.1 == k) e.2)%:R * `|G l 0| <= b * c) ->
  exists f, [/\ balanced load f, (forall f', balanced load f' -> f' = f)
    & forall l : 'I_N, `|fraction * f l 0 - scale_at l * G l 0| <= `|scale_at l| * c].
Proof.
move=> c0 residual; pose D : 'M[F]_N := diag_mx (\row_l scale_at l); pose M := normals radius contacts q.
have AM : A q = D *m M by apply: derivative_scales.
have unit : M^T \in unitmx by rewrite unitmx_tr.
pose f := - (invmx M^T *m load).
have bal : balanced load f by rewrite /balanced mulmxN mulKVmx // addNr.
exists f; split=> // [f' /balancing_forces_are_unique|l]; first exact.
have scale0 m : scale_at m != 0.
  by rewrite /scale_at; have := scales m; case: (contact_at _ _).
pose g : 'cV[F]_N := \col_m (f m 0 / scale_at m).
have fDg : f = D *m g.
  by apply/colP=> m; rewrite mul_diag_mx !mxE mulrC divfK.
have Ag : (A q)^T *m g = - load.
  by rewrite AM trmx_mul tr_diag_mx -mulmxA -fDg; apply/eqP; rewrite -addr_eq0; apply/eqP.
have small : norm (fraction *: g - G) <= c.
  rewrite -(ler_pmul2l b0); apply: le_trans (inverse _) _; apply: norm_le => [|k]; first exact: mulr_ge0 (ltW b0) c0.
  apply: le_trans (residual k); rewrite mulmxBr -scalemxAr Ag.
  have -> : (fraction *: - load - (A q)^T *m G) k 0
     = - ((fraction * load k 0 + ((A q1)^T *m G) k 0) + (((A q)^T - (A q1)^T) *m G) k 0).
    rewrite mulmxBl; move: ((A q)^T *m G) ((A q1)^T *m G) => x y; rewrite !mxE.
    by move: (load k 0) (x k 0) (y k 0) => *; ring.
  rewrite normrN; apply: le_trans (ler_norm_add _ _) _; rewrite ler_add2l mxE.
  apply: le_trans (ler_norm_sum _ _ _) _; apply: ler_sum => m _; rewrite normrM ler_wpmul2r //.
  by have := entry_moves_little m k near; rewrite !mxE.
have -> : fraction * f l 0 - scale_at l * G l 0 = scale_at l * (fraction *: g - G) l 0.
  have -> : f l 0 = scale_at l * g l 0 by rewrite {1}fDg mul_diag_mx !mxE.
  have -> : (fraction *: g - G) l 0 = fraction * g l 0 - G l 0 by rewrite [LHS]mxE [X in X + _]mxE [X in _ + X]mxE.
  by move: (G l 0) (g l 0) (scale_at l) => *; ring.
by rewrite normrM ler_wpmul2l // (le_trans (entry_norm _ _)).
Qed.

Lemma untouched_entry (k l : 'I_N) : (k : nat) \notin coordinates d n (contact_at contacts l) ->
  (normals radius contacts q)^T k l = 0.
Proof.
rewrite -(gradient_coordinates d n 1 (at_ q)) => absent; rewrite !mxE big1_seq ?mul0r // => e /andP[/eqP e1 es]; case/negP: absent.
by rewrite -e1 map_f.
Qed.

(** K7. [zeros] are contacts, [free] degrees of freedom. *)
Theorem structural_zeros (load f : 'cV[F]_N) (zeros free : {set 'I_N}) : balanced load f -> #|free| = #|zeros| ->
  (forall k, k \in free -> load k 0 = 0) ->
  (forall (k l : 'I_N), k \in free -> l \notin zeros -> (k : nat) \notin coordinates d n (contact_at contacts l)) ->
  forall l, l \in zeros -> f l 0 = 0.
Proof.
move=> bal same unloaded apart; have unit : (normals radius contacts q)^T \in unitmx by rewrite unitmx_tr.
apply: (block_solutions_vanish unit _ same) => [k l kf lz|k kf]; first by apply/untouched_entry/apart.
have -> : (normals radius contacts q)^T *m f = - load by apply/eqP; rewrite -addr_eq0; apply/eqP.
by rewrite mxE unloaded ?oppr0.
Qed.
End Forces.

Section Pins.
Variables (F : realFieldType) (d : dimension) (n : nat) (radius : nat -> F) (contacts : seq contact).
Let N := (coordinates_of d n)%N.
Variable q : 'cV[F]_N.

(** C1 (../cells.md). A row that holds a grain along axis a. *)
Definition pins (a : nat) (c : contact) : bool := if c is Held k then (k < n * d)%N && (k %% d == a)%N else false.
(** Rows that move no grain when all move together along a. *)
Definition blind (a : nat) (c : contact) : bool :=
  match c with
  | Image i j _ _ _ => (i < n) && (j < n)
  | Lower i b | Upper i b => [&& i < n, b < d & b != a]
  | Held k => true
  end%N.

(** Contacts push a grain as much as its neighbours: what holds one grain along an axis bears the sum of the loads there. *)
Theorem one_pin_bears_nothing (a : nat) (load f : 'cV[F]_N) : balanced radius contacts q load f -> (a < d)%N ->
  \sum_(i < n) at_ load (i * d + a) = 0 -> (forall l : 'I_N, blind a (contact_at contacts l)) ->
  (forall l l' : 'I_N, pins a (contact_at contacts l) -> pins a (contact_at contacts l') -> l = l') ->
  forall l : 'I_N, pins a (contact_at contacts l) -> f l 0 = 0.
Proof.
move=> bal ad cancel blind_rows alone l pinned.
pose moved k := (k < n * d)%N && (k %% d == a)%N.
pose e : 'cV[F]_N := \col_k (moved k)%:R; pose M := normals radius contacts q.
have at_e k : at_ e k = (moved k)%:R.
  case: (ltnP k N) => kN; first by rewrite (at_ordinal e (Ordinal kN)) mxE.
  rewrite /at_ big1 => [|m /eqP mk]; last by have := ltn_ord m; rewrite mk ltnNge kN.
  by rewrite /moved ltnNge (leq_trans _ kN) // /N; lia.
have grain i z : (i < n)%N -> (z < d)%N -> moved (i * d + z)%N = (z == a).
  move=> i_n zd; rewrite /moved modnMDl modn_small // andb_idl // => _.
  by apply: leq_trans (_ : i.+1 * d <= _)%N; rewrite ?leq_mul2r ?i_n ?orbT // mulSn addnC ltn_add2r.
have cell z : moved (n * d + z)%N = false by rewrite /moved ltnNge leq_addr.
have together i j p p' p'' z : (i < n)%N -> (j < n)%N -> (z < d)%N -> separation d n (at_ e) i j p p' p'' z = 0.
  move=> i_n j_n zd; rewrite separation_is_from_the_image /image_at !at_e; case: z zd => [|[|z]] zd /=;
    by rewrite ?at_e !cell !mul0rz !addr0 !grain // subrr.
have rows k : (M *m e) k 0 = (pins a (contact_at contacts k))%:R.
  have -> : (M *m e) k 0 = (derivative 1 contacts q *m e) k 0 / scale 1 radius (contact_at contacts k).
    by rewrite !mxE mulr_suml; apply: eq_bigr => m _; rewrite !mxE mulrAC.
  rewrite derivative_entry; have := blind_rows k; case: (contact_at contacts k) => [i j p p' p''|i z|i z|m].
  - case/andP=> i_n j_n; rewrite gradient_dot overE big1 ?mul0r // => z _.
    by rewrite -/(separation _ _ _ _ _ _ _ _ _) [X in _ * X]together ?mulr0.
  - by case/and3P=> i_n zd /negPf za; rewrite big_seq1 /= at_e grain // za mulr0 mul0r.
  - by case/and3P=> i_n zd /negPf za; rewrite big_cons big_seq1 /= !at_e cell grain // za !mulr0 addr0 mul0r.
  by rewrite big_seq1 /= at_e mul1r divr1.
have d0 : (0 < d)%N by case: (d).
have counted (k : nat) : (moved k)%:R = \sum_(i < n) (k == i * d + a)%N%:R :> F.
  rewrite /moved; case: (ltnP k (n * d)) => k_n /=; last first.
    rewrite big1 // => i _; case: eqP => // ki; move: k_n; rewrite ki leqNgt.
    by have := grain i a (ltn_ord i) ad; rewrite eqxx /moved => /andP[->].
  have i_n : (k %/ d < n)%N by rewrite ltn_divLR.
  rewrite (bigD1 (Ordinal i_n)) //= big1 ?addr0 => [|i /eqP ne].
    by rewrite {2}(divn_eq k d) eqn_add2l.
  by case: eqP => // ki; case: ne; apply: val_inj; rewrite /= ki divnMDl // divn_small ?addn0.
have load_e : dot load e = 0.
  rewrite -cancel /dot; under eq_bigr => k _ do rewrite mxE counted mulr_sumr.
  rewrite exchange_big; apply: eq_bigr => i _; rewrite /at_ [RHS]big_mkcond; apply: eq_bigr => k _.
  by case: eqP; rewrite ?mulr1 ?mulr0.
have : dot (M^T *m f + load) e = 0 by rewrite bal -(scale0r load) dot_scale mul0r.
rewrite dot_add load_e addr0 dot_transpose trmxK /dot (bigD1 l) //= rows pinned mulr1 big1 ?addr0 // => k /eqP kl.
by rewrite rows; case: (boolP (pins _ _)) => [pk|_]; [case: kl; apply: alone|rewrite mulr0].
Qed.
End Pins.

Print Assumptions balancing_forces_are_unique.
Print Assumptions forces_are_enclosed.
Print Assumptions structural_zeros.
Print Assumptions one_pin_bears_nothing.
