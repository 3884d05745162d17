(* A certificate from the file of integers that Coq would read. This need not be right, but for `natural`: what was checked
   is printed, and compared with the certificate of the program. *)

(* Other words are left out: names, types, punctuation. *)
type token = Integer of Z.t | Word of string | Open | Close

let rec tokens text at () =
  let is_part = function 'a' .. 'z' | 'A' .. 'Z' | '0' .. '9' | '_' -> true | _ -> false in
  let rec stop k = if k < String.length text && is_part text.[k] then stop (k + 1) else k in
  let rec comment_stop k = if String.sub text k 2 = "*)" then k + 2 else comment_stop (k + 1) in
  if at >= String.length text then Seq.Nil
  else
    let stop = stop (at + 1) in
    let part = String.sub text at (stop - at) in
    match text.[at], part with
    | '[', _ -> Seq.Cons (Open, tokens text (at + 1))
    | ']', _ -> Seq.Cons (Close, tokens text (at + 1))
    | '(', _ when text.[at + 1] = '*' -> tokens text (comment_stop at) ()
    | ('-' | '0' .. '9'), _ -> Seq.Cons (Integer (Z.of_string part), tokens text stop)
    | _, ("true" | "false" | "None" | "Some" | "Disks" | "Image" | "Lower" | "Upper" | "Held" | "Plane" | "Space") ->
        Seq.Cons (Word part, tokens text stop)
    | c, _ -> tokens text (if is_part c then stop else at + 1) ()

let rest = ref Seq.empty

let next () =
  match !rest () with
  | Seq.Nil -> failwith "the file ends too soon"
  | Seq.Cons (token, others) -> rest := others; token

let integer () = match next () with Integer z -> z | _ -> failwith "an integer was expected"

(* This has to be right: in the extracted code a natural number is an integer that is not negative. *)
let natural () = let k = integer () in if Z.sign k < 0 then failwith "a natural number was expected" else k
let flag () = match next () with Word "true" -> true | Word "false" -> false | _ -> failwith "a flag was expected"
let pair () = let k = integer () in (k, integer ())

let list item () =
  let rec items found =
    match !rest () with
    | Seq.Cons (Close, others) -> rest := others; List.rev found
    | _ -> items (item () :: found) in
  if next () = Open then items [] else failwith "a list was expected"

let numbers = list integer
let flags = list flag

let contact () =
  let kind = next () in
  let i = natural () in
  match kind with
  | Word "Held" -> Checker.Held i
  | Word "Disks" -> Checker.Image (i, natural (), Z.zero, Z.zero, Z.zero)
  | Word "Image" -> let j = natural () in let k, l = pair () in Checker.Image (i, j, k, l, integer ())
  | Word "Lower" -> Checker.Lower (i, natural ())
  | Word "Upper" -> Checker.Upper (i, natural ())
  | _ -> failwith "a contact was expected"

let dimension () = match next () with Word "Plane" -> Checker.Plane | Word "Space" -> Checker.Space | _ -> failwith "a dimension was expected"
let opening () = match next () with Word "Some" -> Some (natural ()) | Word "None" -> None | _ -> failwith "an end was expected"

(* A function of what is read next, and of what follows. *)
let ( $ ) f item = let x = item () in f x

let solution () = Checker.solution_of $ numbers $ integer $ numbers $ integer
let claim () = Checker.claim_of $ solution $ numbers $ numbers
let load_end () = Checker.end_of $ opening $ flags $ flags $ integer $ integer

let certificate file =
  let file = open_in_bin file in
  rest := tokens (really_input_string file (in_channel_length file)) 0;
  let touching = list contact () in
  let lies_in = dimension () in
  let disks = natural () in
  let vertex = Checker.vertex_of lies_in disks touching $ flags $ flags $ numbers $ numbers $ integer $ integer $ numbers
    $ integer $ integer $ integer $ integer $ integer $ list (list pair) in
  let exponents = numbers () in
  let finite = claim () in
  let infinitesimal = claim () in
  let rate = solution () in
  let lower = load_end () in
  let upper = load_end () in
  let with_forces = Checker.certificate_of vertex finite infinitesimal $ flags $ flags $ integer in
  let stress = integer () in
  if !rest () <> Seq.Nil then failwith "more than a certificate was found";
  (exponents, with_forces rate stress lower upper)
