//! `#[derive(Stateful)]` for `servobench_base::state::Stateful`, where the attributes are described.
//!
//! Every field is saved and restored in the order of the declaration, unless it is marked; a field of a type that is not a state does
//! not compile. A variant of an enum is written by its index.
use proc_macro2::{Ident, TokenStream, TokenTree};
use quote::{format_ident, quote};
use syn::parse::Parser as _;
use syn::punctuated::Punctuated;
use syn::{Attribute, Data, DataEnum, DeriveInput, Error, Fields, Token, WhereClause, parse_macro_input, parse_quote};

/// See the module `servobench_base::state`.
#[proc_macro_derive(Stateful, attributes(state))]
pub fn derive_state(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    implementation(&input).unwrap_or_else(Error::into_compile_error).into()
}

/// Mark of a field: `#[state(constant)]` and the like.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mark {
    /// Part of the state.
    None,
    /// A parameter, or computed anew: neither saved nor restored.
    Constant,
    /// Computed from the rest of the state.
    Derived,
    /// An option, a list or a type whose form the parameters decide.
    Fixed,
}

fn mark(attributes: &[Attribute]) -> Result<Mark, Error> {
    let mut mark = Mark::None;
    for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("state")) {
        let words = Punctuated::<Ident, Token![,]>::parse_terminated;
        for word in words.parse2(attribute.meta.require_list()?.tokens.clone())? {
            let read = match word.to_string().as_str() {
                "constant" | "recomputed" => Mark::Constant,
                "derived" => Mark::Derived,
                "fixed" => Mark::Fixed,
                _ => {
                    return Err(Error::new(
                        word.span(),
                        "not a mark of a state: use constant, derived, recomputed or fixed",
                    ));
                }
            };
            if mark != Mark::None {
                return Err(Error::new(word.span(), "a field has one mark"));
            }
            mark = read;
        }
    }
    Ok(mark)
}

/// The code that saves, restores and makes some fields, each of which is bound to a name.
#[derive(Default)]
struct FieldCode {
    save: TokenStream,
    restore: TokenStream,
    make: TokenStream,
    bindings: Vec<Ident>,
    /// False where parameters are among the fields.
    is_value: bool,
}

fn field_code(fields: &Fields) -> Result<FieldCode, Error> {
    let mut all = FieldCode { is_value: true, ..FieldCode::default() };
    for (index, field) in fields.iter().enumerate() {
        let name = field.ident.as_ref().map_or_else(|| index.to_string(), ToString::to_string);
        // A field may have the name of an argument.
        let binding = format_ident!("field_{name}");
        let mark = mark(&field.attrs)?;
        all.is_value &= matches!(mark, Mark::None | Mark::Derived);
        let (part, save, restore) = match mark {
            Mark::Constant => {
                let ignored = quote!(let _ = #binding;);
                all.save.extend(ignored.clone());
                all.restore.extend(ignored);
                all.bindings.push(binding);
                continue;
            }
            Mark::None => (quote!(field), quote!(Stateful::save), quote!(Stateful::restore)),
            Mark::Derived => (quote!(derived), quote!(Stateful::save), quote!(Stateful::restore)),
            Mark::Fixed => (quote!(field), quote!(FixedForm::save_fixed), quote!(FixedForm::restore_fixed)),
        };
        all.save.extend(quote! {
            to.enter(::servobench_base::state::Part::#part(#name));
            ::servobench_base::state::#save(#binding, to);
            to.leave();
        });
        all.restore.extend(quote!(::servobench_base::state::#restore(#binding, from)?;));
        all.make.extend(quote!(let #binding = ::servobench_base::state::Value::restored(from)?;));
        all.bindings.push(binding);
    }
    Ok(all)
}

fn pattern(fields: &Fields, bindings: &[Ident]) -> TokenStream {
    match fields {
        Fields::Named(named) => {
            let names = named.named.iter().map(|field| &field.ident);
            quote!({ #(#names: #bindings),* })
        }
        Fields::Unnamed(_) => quote!(( #(#bindings),* )),
        Fields::Unit => quote!(),
    }
}

/// Bodies of `save`, `restore` and `restored`, which only a value has.
struct Bodies {
    save: TokenStream,
    restore: TokenStream,
    restored: Option<TokenStream>,
}

fn implementation(input: &DeriveInput) -> Result<TokenStream, Error> {
    let is_fixed = mark(&input.attrs)? == Mark::Fixed;
    let Bodies { save, restore, restored } = match &input.data {
        Data::Struct(data) => of_struct(&data.fields, is_fixed)?,
        Data::Enum(data) => of_enum(data, is_fixed)?,
        Data::Union(data) => return Err(Error::new(data.union_token.span, "a union is not a state")),
    };
    let (name, (generics, arguments, _)) = (&input.ident, input.generics.split_for_impl());
    let bounds = bounds(input, &quote!(Stateful))?;
    let value_bounds = self::bounds(input, &quote!(Value))?;
    let value = restored.map(|restored| {
        quote! {
            #[automatically_derived]
            impl #generics ::servobench_base::state::Value for #name #arguments #value_bounds {
                fn restored(
                    from: &mut ::servobench_base::state::Reader<'_>,
                ) -> ::core::result::Result<Self, ::servobench_base::state::Damaged> {
                    #restored
                }
            }
        }
    });
    Ok(quote! {
        #[automatically_derived]
        impl #generics ::servobench_base::state::Stateful for #name #arguments #bounds {
            fn save(&self, to: &mut dyn ::servobench_base::state::Writer) {
                #save
            }
            fn restore(
                &mut self,
                from: &mut ::servobench_base::state::Reader<'_>,
            ) -> ::core::result::Result<(), ::servobench_base::state::Damaged> {
                #restore
                Ok(())
            }
        }
        #value
    })
}

/// The where clause of the type, and that every field whose type depends on a parameter of it is a state, or a value.
fn bounds(input: &DeriveInput, kind: &TokenStream) -> Result<Option<WhereClause>, Error> {
    let parameters: Vec<String> = input.generics.type_params().map(|parameter| parameter.ident.to_string()).collect();
    let mut generics = input.generics.clone();
    if let (Data::Struct(data), false) = (&input.data, parameters.is_empty()) {
        for field in &data.fields {
            let (kind, of_type) = match mark(&field.attrs)? {
                Mark::Constant => continue,
                Mark::Fixed => (quote!(FixedForm), &field.ty),
                Mark::None | Mark::Derived => (kind.clone(), &field.ty),
            };
            let names =
                |token: TokenTree| matches!(token, TokenTree::Ident(ident) if parameters.contains(&ident.to_string()));
            if flat(quote!(#of_type)).into_iter().any(names) {
                let bound = parse_quote!(#of_type: ::servobench_base::state::#kind);
                generics.make_where_clause().predicates.push(bound);
            }
        }
    }
    Ok(generics.where_clause)
}

/// The tokens within all groups.
fn flat(tokens: TokenStream) -> Vec<TokenTree> {
    let within = |token| match token {
        TokenTree::Group(group) => flat(group.stream()),
        other => vec![other],
    };
    tokens.into_iter().flat_map(within).collect()
}

fn of_struct(fields: &Fields, is_fixed: bool) -> Result<Bodies, Error> {
    let FieldCode { save, restore, make, bindings, is_value } = field_code(fields)?;
    let pattern = pattern(fields, &bindings);
    Ok(Bodies {
        save: quote!(let Self #pattern = self; #save),
        restore: quote!(let Self #pattern = self; #restore),
        restored: (is_value && !is_fixed).then(|| quote!(#make Ok(Self #pattern))),
    })
}

fn of_enum(data: &DataEnum, is_fixed: bool) -> Result<Bodies, Error> {
    let [mut save, mut restore, mut restored] = [(); 3].map(|()| TokenStream::new());
    for (index, variant) in (0_u64..).zip(&data.variants) {
        let fields = field_code(&variant.fields)?;
        if !fields.is_value && !is_fixed {
            let hint = "an enum with parameters in it is `#[state(fixed)]`";
            return Err(Error::new_spanned(variant, hint));
        }
        let (name, pattern) = (&variant.ident, pattern(&variant.fields, &fields.bindings));
        let (save_fields, restore_fields, make_fields) = (fields.save, fields.restore, fields.make);
        save.extend(quote!(Self::#name #pattern => { to.word(#index); #save_fields }));
        restore.extend(quote!((#index, Self::#name #pattern) => { #restore_fields }));
        restored.extend(quote!(#index => { #make_fields Ok(Self::#name #pattern) }));
    }
    let damaged = quote!(_ => return Err(::servobench_base::state::Damaged),);
    let save = quote!(match self { #save });
    if is_fixed {
        return Ok(Bodies { save, restore: quote!(match (from.word()?, self) { #restore #damaged }), restored: None });
    }
    let restore = quote!(*self = ::servobench_base::state::Value::restored(from)?;);
    Ok(Bodies { save, restore, restored: Some(quote!(match from.word()? { #restored #damaged })) })
}
